#pragma once
#include <Eigen/Core>
#include <array>
#include <vector>

#include "vibe_core/geometry/surface_mesh.hpp"

namespace vibe {

/// Finds the triangles of a wall that pass through each other. All pairs without a common vertex count, however near
/// they are along the surface. It is meant to check the simulation from outside and shares nothing with its contact.
class WallCrossings {
 public:
  /// Two triangle numbers, the smaller first.
  using Pair = std::array<int, 2>;

  /// The pairs of triangles that intersect, in ascending order. Triangles that only touch, and triangles in one plane,
  /// do not count. Positions that are not finite cross nothing.
  const std::vector<Pair>& find(const SurfaceView& wall);

 private:
  struct Box {
    Eigen::Array3d low, high;
  };

  void findBoxes(const SurfaceView& wall);
  bool fillCells();
  void tryCell(const SurfaceView& wall, int begin, int end, const Eigen::Array3i& cell);
  Eigen::Array3i cellOf(const Eigen::Array3d& place) const;
  int numberOf(const Eigen::Array3i& cell) const { return (cell.z() * cells_.y() + cell.y()) * cells_.x() + cell.x(); }

  std::vector<Box> boxes_;                          // of the triangles
  Eigen::Array3d origin_ = Eigen::Array3d::Zero();  // of the grid [m]
  double cell_size_ = 0;                            // [m]
  Eigen::Array3i cells_ = Eigen::Array3i::Zero();   // number along each axis
  std::vector<int> begin_;                          // of each cell in triangle_, and one more
  std::vector<int> triangle_;                       // cell by cell
  std::vector<Pair> found_;
};

/// Whether two triangles intersect: an edge of one passes through the other. Touching does not count.
bool trianglesCross(const std::array<Eigen::Vector3d, 3>& a, const std::array<Eigen::Vector3d, 3>& b);

/// Whether the open segment passes through the triangle.
bool segmentPierces(const Eigen::Vector3d& begin, const Eigen::Vector3d& end,
                    const std::array<Eigen::Vector3d, 3>& triangle);

}  // namespace vibe
