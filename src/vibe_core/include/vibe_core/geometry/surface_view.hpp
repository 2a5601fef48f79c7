#pragma once
#include <Eigen/Core>
#include <array>
#include <vector>

namespace vibe {

/// A non-owning view of a deformed surface: the triangles of the rest mesh and positions as a structure of arrays.
struct SurfaceView {
  const std::vector<std::array<int, 3>>& triangles;  ///< vertex numbers
  const std::vector<double>&x, &y, &z;               ///< (vertices) [m]

  Eigen::Vector3d position(int vertex) const { return {x[vertex], y[vertex], z[vertex]}; }
};

}  // namespace vibe
