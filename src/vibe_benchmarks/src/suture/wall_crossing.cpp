#include "suture/wall_crossing.hpp"

#include <utility>

#include "vibe_core/geometry/triangle_tree.hpp"

namespace vibe::benchmarks {

bool wallsCross(const Model& model, const State& state) {
  SurfaceMesh mesh = model.organ.surface;
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) mesh.vertices[v] = {state.x[v], state.y[v], state.z[v]};
  return findSelfIntersection(TriangleTree(std::move(mesh))).first >= 0;
}

}  // namespace vibe::benchmarks
