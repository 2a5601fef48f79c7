#pragma once

#include <vector>

#include "solver/constraint_rows.hpp"
#include "vibe_core/solver/body_loads.hpp"
#include "vibe_core/sparse/block_matrix.hpp"
#include "vibe_core/state/stepper_memory.hpp"

namespace vibe {

/// The pairs of nodes that couplings connect and the pattern does not: sorted, each once, without fixed nodes.
/// @param fixed  per node
std::vector<NodePair> coupledPairs(const std::vector<StiffnessCoupling>& couplings, const std::vector<char>& fixed,
                                   const BlockPattern& pattern);

/// Adds the blocks of couplings to a matrix that has their pairs. Fixed nodes are left out.
void addCouplings(const std::vector<StiffnessCoupling>& couplings, const std::vector<char>& fixed, BlockMatrix& matrix);

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
