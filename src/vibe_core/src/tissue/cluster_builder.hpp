#pragma once

#include <cstdint>
#include <vector>

#include "vibe_core/geometry/organ.hpp"
#include "vibe_core/scene/scene.hpp"

namespace vibe {

struct Organ;

/// Shape-matching clusters in the layout of the kernel. Every particle with its one-ring is a cluster. Eight clusters
/// of similar size form a group. A group has one row per member: row 0 is the centre, then the ring in
/// counter-clockwise order; short rings repeat their last member with weight 0. Arrays by slot are (rows * 8).
struct ClusterSet {
  static constexpr int kLanes = 8;
  int particle_count = 0;
  int group_count = 0;
  std::vector<std::int32_t> row_offset;        ///< first row of each group (group_count + 1)
  std::vector<std::int32_t> particle;          ///< member, by slot
  std::vector<double> weight;                  ///< mass over the cluster's mass, by slot
  std::vector<double> rest_x, rest_y, rest_z;  ///< member minus the cluster's centre of mass at rest [m], by slot
  std::vector<double> gain;                    ///< fraction of the path to the goal per sub-step, (group_count * 8)
  std::vector<double> orientation_weight;  ///< weight of the centre's orientation in the moment matrix [m^2], (.. * 8)
  std::vector<double> rest_spread;         ///< weighted mean square distance from the centre of mass [m^2], (.. * 8)
  std::vector<double> cluster_mass;        ///< [kg], (group_count * 8)
  std::vector<double> compliance;          ///< XPBD compliance alpha per mass, as simulated [s^2], (.. * 8)

  std::vector<std::int32_t> lane_of_particle;  ///< index of each particle's own cluster in the arrays by lane

  // slots that move a particle, ascending
  std::vector<std::int32_t> slot_offset;  ///< (particle_count + 1)
  std::vector<std::int32_t> slot;         ///< (slot_offset.back())

  int rows() const { return row_offset.back(); }
};

/// Builds one cluster per particle with its one-ring. Compliances match tissue.young_modulus and poisson_ratio; the
/// gains are left at 0. See ShapeMatching for the formulas.
/// @throws Error for a vertex that is not surrounded by a closed ring of triangles
ClusterSet buildClusters(const Organ& organ, const TissueScene& tissue, const std::vector<double>& masses,
                         const std::vector<double>& areas);

/// Sets gain = substep^2 / compliance. Where a member of a cluster would move too far in one sweep, the gain is limited
/// and the compliance adjusted accordingly. Explicit integration of a stiffness with a viscous part of time constant
/// stiffness_damping is stable while the gains of all clusters of a particle sum to less than 4 / (1 + 2
/// stiffness_damping / substep); kMaxTotalGain replaces the 4.
/// @return the minimum ratio of simulated to requested stiffness, 1 if nothing was limited
double setGains(ClusterSet& clusters, double substep, double stiffness_damping);

/// The smallest number of substeps per step for which setGains() does not limit any gain.
int fewestSubsteps(const ClusterSet& clusters, double step_period, double stiffness_damping);

/// Includes a margin for stretched states, contacts and grips.
constexpr double kMaxTotalGain = 3.2;

}  // namespace vibe
