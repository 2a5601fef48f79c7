#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "geometry/moving_vertex.hpp"

namespace vibe {

/// Triangles with vertices and colours, as DynamicMesh takes them. Shapes are appended, so that one mesh draws many.
struct ColouredShape {
  std::vector<MovingVertex> vertices;
  std::vector<PackedColour> colours;  ///< one per vertex
  std::vector<std::uint32_t> triangles;

  void clear() { vertices.clear(), colours.clear(), triangles.clear(); }
};

}  // namespace vibe
