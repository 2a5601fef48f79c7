#pragma once
#include <vector>

#include "tissue/cluster_set.hpp"
#include "vibe_core/geometry/organ.hpp"
#include "vibe_core/scene/scene.hpp"

namespace vibe {

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
