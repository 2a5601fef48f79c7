#pragma once
#include <Eigen/Core>
#include <Eigen/SparseCholesky>
#include <cstdint>
#include <vector>

namespace vibe::graphics {

/// The edges of a closed triangle mesh, for smoothing and distances on its surface.
class SurfaceGraph {
 public:
  /// @param triangles  three vertices each, all below the number of vertices
  /// @param places     x y z per vertex [m]
  SurfaceGraph(const std::vector<std::uint32_t>& triangles, const std::vector<float>& places);

  std::size_t vertexCount() const { return first_.size() - 1; }
  double meanEdge() const { return mean_edge_; }  ///< [m]

  /// Shortest way along edges to the nearest of some vertices; infinite without any [m].
  std::vector<double> distanceTo(const std::vector<std::uint32_t>& vertices) const;

  /// One column of values per quantity, blurred by a heat kernel of one implicit step: with (1 - r^2 Laplace) x =
  /// values. The Laplace operator is that of a lattice of equilateral triangles, good enough on an even mesh.
  /// @param radius  r: waves of wave number 1 / r are halved [m]
  Eigen::MatrixXd blurred(const Eigen::MatrixXd& values, double radius) const;

 private:
  std::vector<std::uint32_t> first_,
      neighbours_;              ///< of vertex v: neighbours_[first_[v]] to neighbours_[first_[v + 1]]
  std::vector<double> length_;  ///< of the edges to them [m]
  double mean_edge_ = 0;
};

}  // namespace vibe::graphics
