#pragma once
#include <vector>

#include "tissue/cluster_set.hpp"
#include "vibe_core/geometry/organ.hpp"
#include "vibe_core/scene/scene.hpp"

namespace vibe {

/// One cluster per particle with its one-ring, compliances matched to tissue.young_modulus and poisson_ratio; the
/// gains are left at 0. See ShapeMatching for the formulas.
/// @throws Error for a vertex that is not surrounded by a closed ring of triangles
ClusterSet buildClusters(const Organ& organ, const TissueScene& tissue, const std::vector<double>& masses,
                         const std::vector<double>& areas);

/// Sets gain = substep^2 / compliance, limited where a member of the cluster would otherwise be moved too far in one
/// sweep, and the compliance accordingly: explicit integration of a stiffness with a viscous part of time constant
/// stiffness_damping is stable while the gains of all clusters of a particle sum to less than
/// 4 / (1 + 2 stiffness_damping / substep); kMaxTotalGain takes the place of the 4.
/// @return the minimum of simulated over requested stiffness, 1 if nothing was limited
double setGains(ClusterSet& clusters, double substep, double stiffness_damping);

/// The smallest number of substeps per step for which setGains() limits nothing.
int fewestSubsteps(const ClusterSet& clusters, double step_period, double stiffness_damping);

/// Leaves a margin for stretched states, contacts and grips.
constexpr double kMaxTotalGain = 3.2;

}  // namespace vibe
