#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <vector>

#include "vibe_rviz_plugins/geometry/moving_vertex.hpp"

namespace vibe::rviz_plugins {

/// Triangles with vertices and colours. Shapes are appended, so that one mesh draws many.
struct ColouredShape {
  std::vector<MovingVertex> vertices;
  std::vector<PackedColour> colours;     ///< one per vertex
  std::vector<std::uint32_t> triangles;  ///< three vertex numbers each, counter-clockwise seen from outside

  void clear() { vertices.clear(), colours.clear(), triangles.clear(); }
};

/// Why this shape cannot be drawn, as one sentence; empty: it can. Graphics libraries abort on such shapes.
std::string problemOf(const ColouredShape& shape);

}  // namespace vibe::rviz_plugins
