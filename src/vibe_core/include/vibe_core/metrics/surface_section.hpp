#pragma once
#include <Eigen/Core>
#include <array>
#include <vector>

#include "vibe_core/geometry/surface_mesh.hpp"

namespace vibe {

/// Cuts a closed surface with planes. Keeps the adjacency of the triangles and the memory of a cut, so that later cuts
/// do not allocate. A cut visits every vertex and triangle twice.
class SurfaceSection {
 public:
  /// One closed line of a section.
  struct Loop {
    double area = 0;   ///< enclosed; negative if the inside of the surface is outside of the loop (a hole) [m^2]
    double label = 0;  ///< mean of the labels at the edges it cuts; NaN for none, in their unit
  };

  /// @param surface  closed, oriented outwards; only its triangles are used
  explicit SurfaceSection(const SurfaceMesh& surface);

  /// @param x, y, z  present positions of the vertices, shape (vertices) [m]
  /// @param point    of the plane [m]
  /// @param normal   unit vector
  /// @param label    one number per vertex, to tell loops apart; NaN: none
  /// @return in the order of the triangles; valid until the next cut
  const std::vector<Loop>& cut(const std::vector<double>& x, const std::vector<double>& y, const std::vector<double>& z,
                               const Eigen::Vector3d& point, const Eigen::Vector3d& normal,
                               const std::vector<double>& label);

 private:
  int downEdge(int triangle) const;
  Loop trace(int first, const std::vector<double>& x, const std::vector<double>& y, const std::vector<double>& z,
             const Eigen::Vector3d& point, const Eigen::Vector3d& normal, const std::vector<double>& label);

  std::vector<std::array<int, 3>> triangles_;
  std::vector<std::array<int, 3>> neighbour_;  // across the edge from corner k to corner k + 1
  std::vector<double> height_;                 // of the vertices above the plane [m]
  std::vector<char> above_;                    // (vertices)
  std::vector<char> done_;                     // (triangles)
  std::vector<Loop> loops_;
};

}  // namespace vibe
