#pragma once

#include <functional>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "vibe_core/geometry/surface_mesh.hpp"

namespace vibe {

/// Smooth union of balls along curves: a field whose zero level set is one smooth surface around all of them,
///   f(p) = -k log sum_i w_i exp((r_i - |D (p - c_i)|) / k),   D = diag(1 / flattening, 1, 1).
/// Close to the surface f is approximately the signed distance, negative inside.
class BallUnion {
 public:
  /// @param blend      k: blending width between neighbouring parts [m]
  /// @param flattening ratio of depth (along x) to width of a section
  BallUnion(double blend, double flattening) : blend_(blend), flattening_(flattening) {}

  /// Adds a ball of a row of balls with this spacing. The weight is chosen such that a long straight row has its
  /// surface at `radius` for any spacing.
  void add(const Eigen::Vector3d& centre, double radius, double spacing);

  double value(const Eigen::Vector3d& p) const;

  /// Point of the surface near p, along the gradient. p should be within about `blend` of the surface.
  Eigen::Vector3d project(const Eigen::Vector3d& p) const;

 private:
  struct Ball {
    Eigen::Vector3d centre;
    double radius;
    double weight;
  };

  Eigen::Vector3d offset(const Eigen::Vector3d& p, const Ball& ball) const;  ///< D (p - c)
  double evaluate(const Eigen::Vector3d& p, Eigen::Vector3d* gradient) const;

  double blend_;
  double flattening_;
  std::vector<Ball> balls_;
};

/// Extracts the closed zero surface of a field, oriented towards positive values. Cubes are cut into six tetrahedra
/// each (Kuhn), so the result is always manifold. Its triangles are uneven: remesh before use.
/// @param field signed: negative inside, positive on the boundary of the box
/// @param box   [m]
/// @param cell  edge of a cube [m]
SurfaceMesh marchTetrahedra(const std::function<double(const Eigen::Vector3d&)>& field, const Eigen::AlignedBox3d& box,
                            double cell);

}  // namespace vibe
