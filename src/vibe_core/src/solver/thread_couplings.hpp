#pragma once

#include <vector>

#include "solver/constraint_rows.hpp"
#include "vibe_core/solver/body_loads.hpp"

namespace vibe {

/// A tense segment of thread resists being turned: its tension over its length is the stiffness of two springs across
/// it. This is their compliance [m/N].
double turnCompliance(double length, double tension);

/// Unit vector along a segment; any where its ends have met, because then the pull is zero.
Eigen::Vector3d segmentDirection(const Eigen::Vector3d& between);

/// Appends the stiffness of the springs across the tense segments at positions (4 per node) [m], with the tensions of
/// the loads, for the factor of later steps.
/// @param gain  of the rows' values over positions, see setStepTargets(); 1 in an equilibrium
void addThreadCouplings(const BodyLoads& loads, const double* positions4, double gain,
                        std::vector<StiffnessCoupling>& couplings);

/// Finds the part of the stiffness of these springs that a factor with the couplings does not have, for the rows of the
/// loads' threads: where it is small, the iterations find its effect without a row.
void findMissingTurns(const BodyLoads& loads, const std::vector<StiffnessCoupling>& in_factor, ConstraintRows& rows);

}  // namespace vibe
