#include "geometry/mesh_stream.hpp"

#include <array>
#include <cstdint>
#include <cstring>
#include <limits>

#include "vibe_core/common/error.hpp"

namespace vibe {

namespace {

constexpr std::size_t kWordSize = 8;
const std::string kMeshWord = "VIBEMESH";
const std::string kFailureWord = "VIBEFAIL";
constexpr std::size_t kVertexSize = 3 * sizeof(double);
constexpr std::size_t kTriangleSize = 3 * sizeof(std::int32_t);

template <class T>
void put(std::string& bytes, const T* values, std::size_t count) {
  bytes.append(reinterpret_cast<const char*>(values), count * sizeof(T));
}

[[noreturn]] void failDamaged() {
  throw Error("the reader returns no complete surface");
}

/// Numbers of vertices and triangles; fails unless exactly that amount of data follows.
std::array<std::uint64_t, 2> readCounts(const std::string& bytes) {
  std::array<std::uint64_t, 2> counts{};
  const std::size_t head = kWordSize + sizeof counts;
  if (bytes.size() < head || bytes.compare(0, kWordSize, kMeshWord) != 0) failDamaged();
  std::memcpy(counts.data(), bytes.data() + kWordSize, sizeof counts);
  constexpr std::uint64_t kMax = std::numeric_limits<std::int32_t>::max();
  if (counts[0] > kMax || counts[1] > kMax) failDamaged();
  if (bytes.size() != head + counts[0] * kVertexSize + counts[1] * kTriangleSize) failDamaged();
  return counts;
}

}  // namespace

std::string packMesh(const SurfaceMesh& mesh) {
  const std::array<std::uint64_t, 2> counts{mesh.vertices.size(), mesh.triangles.size()};
  std::string bytes = kMeshWord;
  put(bytes, counts.data(), counts.size());
  for (const auto& v : mesh.vertices) put(bytes, v.data(), 3);
  for (const auto& t : mesh.triangles) put(bytes, t.data(), 3);
  return bytes;
}

std::string packFailure(const std::string& reason) {
  return kFailureWord + reason;
}

SurfaceMesh unpackMesh(const std::string& bytes) {
  if (bytes.compare(0, kWordSize, kFailureWord) == 0) throw Error(bytes.substr(kWordSize));
  const std::array<std::uint64_t, 2> counts = readCounts(bytes);
  const char* place = bytes.data() + kWordSize + 2 * sizeof(std::uint64_t);
  SurfaceMesh mesh;
  mesh.vertices.resize(counts[0]);
  for (auto& v : mesh.vertices) {
    std::memcpy(v.data(), place, kVertexSize);
    place += kVertexSize;
  }
  mesh.triangles.resize(counts[1]);
  for (auto& t : mesh.triangles) {
    std::memcpy(t.data(), place, kTriangleSize);
    place += kTriangleSize;
  }
  return mesh;
}

}  // namespace vibe
