#pragma once
#include <Eigen/Core>
#include <array>
#include <vector>

#include "vibe_core/geometry/surface_mesh.hpp"

namespace vibe {

/// Cuts a closed surface with planes. Keeps the neighbourhood of the triangles and the memory for a cut, so that a cut
/// asks for none after the first few. Costs two looks at every vertex and triangle.
class SurfaceSection {
 public:
  /// One closed line of a section.
  struct Loop {
    double area =
        0;  ///< enclosed; negative around a hole, where the inside of the surface is outside of the loop [m^2]
    double label = 0;  ///< mean of the labels at the edges it cuts; NaN for none
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
  Loop update(int first, const std::vector<double>& x, const std::vector<double>& y, const std::vector<double>& z,
              const Eigen::Vector3d& point, const Eigen::Vector3d& normal, const std::vector<double>& label);

  std::vector<std::array<int, 3>> triangles_;
  std::vector<std::array<int, 3>> neighbour_;  // across the edge from corner k to corner k + 1
  std::vector<double> height_;                 // of the vertices above the plane [m]
  std::vector<char> above_;                    // vertices
  std::vector<char> done_;                     // triangles
  std::vector<Loop> loops_;
};

}  // namespace vibe
