#pragma once
#include <Eigen/Core>
#include <array>
#include <vector>

namespace vibe {

/// A deformed surface where it lies: triangles of the rest mesh, positions in structure of arrays. Owns nothing.
struct SurfaceView {
  const std::vector<std::array<int, 3>>& triangles;  ///< vertex numbers
  const std::vector<double>&x, &y, &z;               ///< (vertices) [m]

  Eigen::Vector3d position(int vertex) const { return {x[vertex], y[vertex], z[vertex]}; }
};

}  // namespace vibe
