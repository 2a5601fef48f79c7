#include "method/tet_wall.hpp"
#include "constraints/group_draw.hpp"

#include <Eigen/Geometry>
#include <algorithm>

#include "tissue/tetrahedra.hpp"

namespace vibe::benchmarks {
namespace {

/// Divides a prism on a triangle into three tetrahedra. Every side is cut from its lower inner node to its higher outer
/// node, so that neighbours match.
void addPrism(std::array<int, 3> triangle, int inner_count, TetMesh<4>& mesh) {
  std::sort(triangle.begin(), triangle.end());
  const auto [a, b, c] = triangle;
  for (auto tet : {std::array<int, 4>{a, b, c, c + inner_count},
                   {a, b, b + inner_count, c + inner_count},
                   {a, a + inner_count, b + inner_count, c + inner_count}}) {
    const auto side = [&](int k) { return Eigen::Vector3d(mesh.nodes[tet[k]] - mesh.nodes[tet[0]]); };
    if (side(1).cross(side(2)).dot(side(3)) < 0) std::swap(tet[1], tet[2]);
    mesh.elements.push_back(tet);
  }
}

TetMesh<4> thickened(const SurfaceMesh& surface) {
  const int count = static_cast<int>(surface.vertices.size());
  const auto normals = vertexNormals(surface);
  TetMesh<4> mesh;
  for (const double part : {-0.5, 0.5})
    for (std::size_t n = 0; n < normals.size(); ++n)
      mesh.nodes.emplace_back(surface.vertices[n] + part * kWallThickness * normals[n]);
  mesh.materials = {kWallTissue};
  for (const auto& triangle : surface.triangles) addPrism(triangle, count, mesh);
  return mesh;
}

BodyMotion middleOf(const BodyMotion& layers, const BodyMotion& shape) {
  BodyMotion middle = shape;
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t count = middle.x[k].size();
    for (std::size_t n = 0; n < count; ++n) {
      middle.x[k][n] = 0.5 * (layers.x[k][n] + layers.x[k][n + count]);
      middle.v[k][n] = 0.5 * (layers.v[k][n] + layers.v[k][n + count]);
    }
  }
  return middle;
}

}  // namespace

BenchWall makeTetWall(const BenchWall& wall) {
  const int count = wall.body.nodeCount();
  BenchWall tets;
  tets.mesh = wall.mesh;
  tets.pull_direction = wall.pull_direction;
  tets.pressure = wall.pressure;
  tets.rest_volume = wall.rest_volume;
  for (const int offset : {0, count})
    for (const int node : wall.tool) tets.tool.push_back(node + offset);
  TetMesh<4> mesh = thickened(wall.mesh);
  tets.body.rest = mesh.nodes;
  tets.body.fixed = wall.body.fixed;
  tets.body.fixed.insert(tets.body.fixed.end(), wall.body.fixed.begin(), wall.body.fixed.end());
  const auto elements = std::make_shared<TetElements<4>>(std::move(mesh));
  tets.body.mass = elements->lumpedMass(kWallDensity);
  tets.body.elements = elements;
  tets.body.mass_damping = wall.body.mass_damping;
  tets.layers = std::make_shared<LayerPressure>(wall.mesh.triangles, count);
  return tets;
}

Trajectory runTets(const BenchWall& wall, const Pull& pull, const StepChoice& choice) {
  const BenchWall tets = makeTetWall(wall);
  Trajectory trajectory = update(tets, inflate(tets, 1e-7), pull, choice);
  for (BodyMotion& frame : trajectory.frames) frame = middleOf(frame, BodyMotion(wall.body));
  return trajectory;
}

}  // namespace vibe::benchmarks
