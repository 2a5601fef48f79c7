#pragma once
#include <memory>

#include "tissue/cluster_builder.hpp"
#include "vibe_core/geometry/organ.hpp"
#include "vibe_core/scene/scene.hpp"
#include "vibe_core/tissue/tissue_model.hpp"

namespace vibe {

/// Oriented-particle shape matching on the wall, the tissue model of Erden et al. (ViBE). Every particle and its
/// one-ring form a cluster that preserves its shape up to a rigid motion,
///   E = sum over clusters of 1 / (2 alpha) * sum over members of m |x - goal|^2      [J]
/// where alpha [s^2] is an XPBD compliance (Macklin, Mueller & Chentanez 2016; with lambda reset every sub-step, one
/// projection moves a member towards its goal). Two properties make the method match a given modulus:
/// * alpha is chosen per cluster such that a uniform in-plane stretch has the energy of an isotropic membrane,
///   E t / (1 - nu) strain^2 per area: alpha = sum m |r|^2 / (2 E t A / (1 - nu)).
/// * the clusters of a sweep use the same positions (Jacobi), those at the start of the sub-step, and move their
/// members
///   by the fraction h^2 / alpha: the equilibrium is that of E for any sub-step, and energy is conserved. (The usual
///   order, projection after prediction, damps motion and is stable only for a third of the stiffness.) The fraction
///   is limited where the sub-step is too long for stability; stiffnessRatio() then falls below 1.
/// Conserves linear momentum exactly and angular momentum up to the exchange with the orientations of the particles.
///
/// Limitations: the response to shear equals that to dilation (an in-plane Poisson ratio of 0 scaled to the dilation
/// modulus). The stress is linear in stretch, so there is a pressure above which the organ bursts. The bending
/// stiffness follows from the size of the ring, not from the thickness (correct within a factor of 1.5 if the particle
/// spacing is about 1.7 times the wall thickness). Measured errors: docs/accuracy.md.
class ShapeMatching : public TissueModel {
 public:
  /// @param masses  of the particles [kg]
  /// @param areas   of wall per particle at rest [m^2]
  /// @param step_period  divided into tissue.substeps or, if that is 0, into the fewest substeps that carry the
  ///         stiffness, `at_least` or more [s]
  ShapeMatching(const Organ& organ, const TissueScene& tissue, const std::vector<double>& masses,
                const std::vector<double>& areas, double step_period, int at_least = 1);

  std::string name() const override { return "shape_matching"; }
  double energy(const State& state) const override;
  void addForces(const State& state, double* fx, double* fy, double* fz) const override;
  void strain(const State& state, float* out) const override;
  double stiffnessRatio() const override { return stiffness_ratio_; }

  int substeps() const { return substeps_; }
  const ClusterSet& clusters() const { return clusters_; }

 private:
  ClusterSet clusters_;
  std::vector<double> masses_;
  int substeps_;
  double substep_;  // [s]
  double stiffness_ratio_ = 1;
};

/// Buffers of a sweep; sized by makeSweepBuffers().
struct SweepBuffers {
  std::vector<double> dx, dy, dz;              ///< by slot
  std::vector<double> qw, qx, qy, qz;          ///< by lane
  std::vector<double> wx, wy, wz;              ///< by lane
  std::vector<double> area_x, area_y, area_z;  ///< by lane
  std::vector<double> spread;                  ///< by lane
};
SweepBuffers makeSweepBuffers(const ClusterSet& clusters);

/// Copies orientations and angular velocities from the order of the state (particles) to that of the sweep (lanes), and
/// back.
void loadOrientations(const ClusterSet& clusters, const State& state, SweepBuffers& buffers);
void storeOrientations(const ClusterSet& clusters, const SweepBuffers& buffers, State& state);

struct ClusterSweep;
/// Binds the constant arrays, the buffers and the positions of `state`.
ClusterSweep bindSweep(const ClusterSet& clusters, const State& state, SweepBuffers& buffers);

}  // namespace vibe
