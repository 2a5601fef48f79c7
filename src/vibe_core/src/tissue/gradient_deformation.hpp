#pragma once
#include <Eigen/Geometry>
#include <Eigen/SparseCholesky>
#include <vector>

#include "vibe_core/geometry/surface_view.hpp"

namespace vibe {

/// Nodes within a way along sides from any of the seeds, ascending. Empty for seeds outside the surface.
/// @param radius [m]
std::vector<int> patchAround(const SurfaceView& shape, const std::vector<int>& seeds, double radius);

/// Gradient-domain deformation of a patch of the wall: shape without mechanics, an order of magnitude cheaper than a
/// solver. What the ViBE prototype does while the wall is marked (Erden et al., section 2.1.1).
///
/// Handles are put where the tool has them and the rim of the patch stays where it is; the rest keeps the gradient
/// of its shape, turned, as well as it can: the Poisson equation of Yu et al. 2004 ("Mesh editing with Poisson-based
/// gradient field manipulation") with the cotangent Laplacian L of the shape at the start,
///   sum_j w_ij (x_i - x_j) = sum_j w_ij (R_i + R_j) / 2 (x0_i - x0_j).
/// The rotations R_i start as that of the rigid motion that fits rim and handles best and are improved in turn with
/// the positions, as in Sorkine and Alexa 2007 ("As-rigid-as-possible surface modeling"). A rigid motion of rim and
/// handles is reproduced to rounding, and without improvement of the rotations every affine one of a flat patch too.
/// L is factored once per set of handles.
///
/// Limits: no force, no pressure, no inertia and no contact: what it says is a shape. It does not know the thickness
/// or the elasticity of the wall; it agrees with the shell only as far as the radius of the patch is chosen well.
/// Continuous at the rim, with a kink. The result depends on shape, handles and targets alone, not on calls before.
/// Not shared between threads of control; deform() allocates in its first call only.
class GradientDeformation {
 public:
  /// @param shape    the wall as it is now; not used after the call
  /// @param patch    nodes, each once
  /// @param handles  nodes of the patch, each once
  /// @param turns    how often the rotations are improved, 0 to 100
  /// @throws Error if a handle is not in the patch, if nothing is held, or for triangles without area
  GradientDeformation(const SurfaceView& shape, std::vector<int> patch, const std::vector<int>& handles, int turns = 2);

  /// Other nodes to hold, of the same patch and shape: factors anew.
  void setHandles(const std::vector<int>& handles);

  const std::vector<int>& patch() const { return patch_; }  ///< node numbers of the surface
  const std::vector<int>& rim() const { return rim_; }      ///< the outermost of them

  /// @param targets    of the handles in their order, in world [m]
  /// @param positions  out: of the patch in its order [m]
  /// @throws Error for another number of targets than handles
  void deform(const std::vector<Eigen::Vector3d>& targets, std::vector<Eigen::Vector3d>& positions);

 private:
  struct Side {
    int to;               // place in the patch
    double weight;        // half the sum of the cotangents
    Eigen::Vector3d arm;  // weight times the side at the start, from there to here [m]
  };

  void addTriangle(const std::array<int, 3>& t);
  void factor();
  void placeHeld(const std::vector<Eigen::Vector3d>& targets, std::vector<Eigen::Vector3d>& positions);
  void improveRotations(const std::vector<Eigen::Vector3d>& positions);
  void solve(std::vector<Eigen::Vector3d>& positions);

  int turns_;
  std::vector<int> patch_, rim_;
  std::vector<int> place_;                 // (nodes of the surface) in the patch, -1: outside
  std::vector<Eigen::Vector3d> start_;     // (patch) [m]
  std::vector<std::vector<Side>> sides_;   // (patch)
  std::vector<char> outer_;                // (patch) 1: of the rim
  std::vector<int> handles_;               // places in the patch
  std::vector<int> unknown_;               // (patch) row of a free node, -1: held
  std::vector<int> held_;                  // places
  std::vector<Eigen::Matrix3d> rotation_;  // (patch)

  Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factor_;
  Eigen::VectorXd inverse_diagonal_;
  Eigen::Matrix<double, Eigen::Dynamic, 3> right_, permuted_;
};

}  // namespace vibe
