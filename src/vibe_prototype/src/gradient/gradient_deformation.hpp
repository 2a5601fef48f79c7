#pragma once
#include <Eigen/Geometry>
#include <Eigen/SparseCholesky>
#include <vector>

#include "vibe_core/geometry/surface_mesh.hpp"

namespace vibe::prototype {

/// Nodes within a distance along edges from any of the seeds, ascending. Empty for seeds outside the surface.
/// @param radius [m]
std::vector<int> patchAround(const SurfaceView& shape, const std::vector<int>& seeds, double radius);

/// Gradient-domain deformation of a patch of the wall: a geometric method without mechanics, an order of magnitude
/// cheaper than a solver. The ViBE prototype uses it while the wall is marked (Erden et al., section 2.1.1).
///
/// Handles are placed at the positions of the tool, and the rim of the patch stays in place. The rest preserves the
/// rotated gradient of its shape as well as possible: the Poisson equation of Yu et al. 2004 ("Mesh editing with
/// Poisson-based gradient field manipulation") with the cotangent Laplacian L of the initial shape,
///   sum_j w_ij (x_i - x_j) = sum_j w_ij (R_i + R_j) / 2 (x0_i - x0_j).
/// The rotations R_i start as that of the rigid motion that best fits rim and handles. They are improved in alternation
/// with the positions, as in Sorkine and Alexa 2007 ("As-rigid-as-possible surface modeling"). A rigid motion of rim
/// and handles is reproduced to rounding. Without improvement of the rotations, so is every affine motion of a flat
/// patch. L is factored once per set of handles.
///
/// Limits: no force, pressure, inertia or contact: the result is only a shape. It does not depend on the thickness or
/// the elasticity of the wall and agrees with the shell only if the radius of the patch is chosen well. Continuous at
/// the rim, with a kink. The result depends only on shape, handles and targets, not on previous calls. Not thread-safe;
/// deform() allocates in its first call only.
class GradientDeformation {
 public:
  /// @param shape    the wall in its current shape; not used after the call
  /// @param patch    nodes, each once
  /// @param handles  nodes of the patch, each once
  /// @param turns    number of improvements of the rotations, 0 to 100
  /// @throws Error if a handle is not in the patch, if nothing is held, or for triangles without area
  GradientDeformation(const SurfaceView& shape, std::vector<int> patch, const std::vector<int>& handles, int turns = 2);

  /// Changes the held nodes, for the same patch and shape. Recomputes the factor.
  void setHandles(const std::vector<int>& handles);

  const std::vector<int>& patch() const { return patch_; }  ///< node numbers of the surface
  const std::vector<int>& rim() const { return rim_; }      ///< the outermost nodes of the patch

  /// @param targets    of the handles in their order, in world [m]
  /// @param positions  out: of the patch in its order [m]
  /// @throws Error if the number of targets differs from that of the handles
  void deform(const std::vector<Eigen::Vector3d>& targets, std::vector<Eigen::Vector3d>& positions);

 private:
  struct Side {
    int to;               // index in the patch
    double weight;        // half the sum of the cotangents
    Eigen::Vector3d arm;  // weight times the initial edge vector, from there to here [m]
  };

  void addTriangle(const std::array<int, 3>& t);
  void factor();
  void placeHeld(const std::vector<Eigen::Vector3d>& targets, std::vector<Eigen::Vector3d>& positions);
  void improveRotations(const std::vector<Eigen::Vector3d>& positions);
  void solve(std::vector<Eigen::Vector3d>& positions);

  int turns_;
  std::vector<int> patch_, rim_;
  std::vector<int> place_;                 // (nodes of the surface) index in the patch, -1: outside
  std::vector<Eigen::Vector3d> start_;     // (patch) [m]
  std::vector<std::vector<Side>> sides_;   // (patch)
  std::vector<char> outer_;                // (patch) 1: on the rim
  std::vector<int> handles_;               // indices in the patch
  std::vector<int> unknown_;               // (patch) row of a free node, -1: held
  std::vector<int> held_;                  // indices in the patch
  std::vector<Eigen::Matrix3d> rotation_;  // (patch)

  Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factor_;
  Eigen::VectorXd inverse_diagonal_;
  Eigen::Matrix<double, Eigen::Dynamic, 3> right_, permuted_;
};

}  // namespace vibe::prototype
