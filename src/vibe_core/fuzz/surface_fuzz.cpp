// sources: src/geometry/mesh_file.cpp src/geometry/*_reader.cpp src/geometry/polygon.cpp src/geometry/text_lines.cpp
// sources: src/geometry/gltf_values.cpp src/files/number_text.cpp
// sources: src/files/files.cpp src/files/foreign_content.cpp
// sources: src/geometry/surface_check.cpp src/geometry/triangle_tree.cpp src/geometry/surface_mesh.cpp
// sources: src/geometry/remesh.cpp src/geometry/editable_mesh.cpp src/geometry/surface_operators.cpp
// sources: src/geometry/regions.cpp src/geometry/stomach_axis.cpp src/geometry/landmark_estimate.cpp
// sources: src/arithmetic/elementary_*.cpp
// includes: ../vibe_firmware/fuzz
// units: 100
#include <cmath>
#include <cstring>
#include <numeric>

#include "fuzz_input.hpp"
#include "geometry/regions.hpp"
#include "geometry/remesh.hpp"
#include "geometry/surface_check.hpp"
#include "vibe_core/geometry/mesh_file.hpp"
#include "vibe_core/program/error.hpp"

// Any bytes as vertices and triangles, and a small body after moves, cuts and other changes:
// an Error with its sentence, or a surface that is welded and checked. Of thirty-two, one is then covered evenly with
// vertices and labelled, and one is searched for landmarks, which is slow.

namespace {

using namespace vibe;
using vibe_firmware::FuzzInput;
using vibe_firmware::require;

constexpr int kVertices = 100;  // the fewest of an organ

/// An octahedron of about the size of an organ.
SurfaceMesh octahedron() {
  SurfaceMesh mesh;
  for (int axis = 0; axis < 3; ++axis)
    for (const double side : {0.1, -0.1}) mesh.vertices.emplace_back(side * Eigen::Vector3d::Unit(axis));
  mesh.triangles = {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4}, {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}};
  return mesh;
}

/// Eight bytes, the numbers of vertices and triangles, coordinates and corners; empty if the bytes are not so many.
SurfaceMesh unpack(const std::uint8_t* data, std::size_t size) {
  SurfaceMesh mesh;
  std::uint64_t counts[2] = {0, 0};
  constexpr std::size_t kHead = 8 + sizeof counts, kVertex = 3 * sizeof(double), kTriangle = 3 * sizeof(std::int32_t);
  if (size < kHead) return mesh;
  std::memcpy(counts, data + 8, sizeof counts);
  if (counts[0] > size || counts[1] > size || size != kHead + counts[0] * kVertex + counts[1] * kTriangle) return mesh;
  mesh.vertices.resize(counts[0]);
  mesh.triangles.resize(counts[1]);
  for (std::size_t v = 0; v < counts[0]; ++v) std::memcpy(mesh.vertices[v].data(), data + kHead + v * kVertex, kVertex);
  for (std::size_t t = 0; t < counts[1]; ++t)
    std::memcpy(mesh.triangles[t].data(), data + kHead + counts[0] * kVertex + t * kTriangle, kTriangle);
  return mesh;
}

/// A length of any size, often near that of an organ [m].
double anyLength(FuzzInput& input) {
  const int exponent = input.byte();
  const double value = (input.byte() - 128) * 1e-3;
  return exponent < 224 ? value : value * std::pow(10.0, 25 * (exponent - 240));
}

void change(FuzzInput& input, SurfaceMesh& mesh) {
  const int kind = input.byte() % 8;
  Eigen::Vector3d& vertex = mesh.vertices[input.byte() % mesh.vertices.size()];
  std::array<int, 3>& triangle = mesh.triangles[input.byte() % mesh.triangles.size()];
  if (kind == 0) vertex[input.byte() % 3] = anyLength(input);
  if (kind == 1) triangle[input.byte() % 3] = input.byte() % static_cast<int>(mesh.vertices.size() + 1);
  if (kind == 2) mesh.triangles.push_back({triangle[1], triangle[0], input.byte() % 8});
  if (kind == 3 && mesh.triangles.size() > 1) mesh.triangles.pop_back();
  if (kind < 4) return;
  // a new vertex near the middle of a triangle, which is cut in three
  const std::array<int, 3> old = triangle;
  const int middle = static_cast<int>(mesh.vertices.size());
  mesh.vertices.emplace_back(0, 0, 0);
  for (const int v : old)
    if (v >= 0 && v < middle) mesh.vertices.back() += mesh.vertices[v] / 3 * (0.5 + input.byte() / 255.0);
  triangle[2] = middle;
  mesh.triangles.push_back({old[1], old[2], middle});
  mesh.triangles.push_back({old[2], old[0], middle});
}

void label(SurfaceMesh surface, FuzzInput& input) {
  Organ organ;
  const auto anyVertex = [&] { return surface.vertices[input.word() % surface.vertices.size()]; };
  organ.end.assign(surface.vertices.size(), End::None);
  organ.end[input.word() % organ.end.size()] = End::Oesophagus;
  organ.end[input.word() % organ.end.size()] = End::Duodenum;
  organ.entry = anyVertex();
  organ.landmarks = {anyVertex(), anyVertex(), anyVertex(), anyVertex()};
  organ.landmarks.incisura.z() += anyLength(input);
  organ.surface = std::move(surface);
  labelStomach(organ);
  for (const double value : thicknessFromRegions(organ.surface, organ.region, {1, 2, 3, 4, 5})) require(value > 0);
}

/// What becomes of a surface from a file until it is an organ.
/// @param sum  of all bytes: says how far
void import(const SurfaceMesh& raw, unsigned sum, FuzzInput& input) {
  try {
    checkNumbers(raw, "fuzz.obj");
    SurfaceMesh mesh = weld(raw, 1e-6);
    checkSurface(mesh, "fuzz.obj");
    orientOutwards(mesh);
    if (sum % 32 > 1) return;
    const SurfaceMesh even = remeshSurface(mesh, kVertices);
    require(even.vertices.size() == kVertices);
    checkSurface(even, "fuzz.obj");
    if (sum % 32 == 0) label(even, input);
    if (sum % 32 == 1) estimateLandmarks(even);
  } catch (const Error& error) {
    require(error.what()[0] != '\0');
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  FuzzInput none(data, 0), input(data, size);
  const unsigned sum = std::accumulate(data, data + size, 0U);
  import(unpack(data, size), sum, none);
  SurfaceMesh mesh = octahedron();
  for (int changes = input.byte() % 64; changes > 0 && !input.empty(); --changes) change(input, mesh);
  import(mesh, sum, input);
  return 0;
}
