#pragma once

#include <algorithm>
#include <vector>

#include "vibe_core/geometry/surface_mesh.hpp"

namespace vibe {

/// Says which vertices of a surface are so near along it that they belong to the same wall.
class SurfaceWalls {
 public:
  /// @param reach  distance along edges within which the surface is one wall; vertices within two edges always are [m]
  SurfaceWalls(const SurfaceMesh& rest, double reach);

  bool oneWall(int vertex, int other) const {
    return std::binary_search(wall_.begin() + start_[vertex], wall_.begin() + start_[vertex + 1], other);
  }

 private:
  std::vector<int> start_, wall_;  // vertices of the same wall, ascending
};

}  // namespace vibe
