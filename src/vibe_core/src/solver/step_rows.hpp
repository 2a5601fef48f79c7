#pragma once

#include <vector>

#include "solver/row_system.hpp"
#include "solver/time_scheme.hpp"
#include "vibe_core/solver/body_loads.hpp"
#include "vibe_core/solver/elastic_body.hpp"

namespace vibe {

/// The constraints, contacts and threads of the loads as rows for the positions at which forces are evaluated. The
/// lengths of segments of thread are linearised about the given positions.
void buildRows(const BodyLoads& loads, const MotionView& motion, RowSystem& system);
/// The values that the rows have in the equilibrium itself.
/// @param z  where the solve starts: the deepest contacts there count, see limitContacts() [m]
void setEquilibriumTargets(const BodyLoads& loads, const std::vector<double>& z, RowSystem& system);
/// The same for a step: rows are met at its end, so that z has to move by the scheme's ratio of gains times as much.
/// Scales the compliances of the rows in the same way.
/// @param in_factor  stiffness that the factor has beside that of the elements
/// @param z          as for an equilibrium
void setStepTargets(const BodyLoads& loads, const MotionView& motion, const TimeScheme& scheme,
                    const std::vector<StiffnessCoupling>& in_factor, const std::vector<double>& z, RowSystem& system);
/// The targets alone, after rows have got other numbers.
void setTargetsOfStep(const BodyLoads& loads, const MotionView& motion, const TimeScheme& scheme, RowSystem& system);
/// The forces of contacts back to the loads, and how far the tool yields.
void storeToolForces(const RowSystem& system, BodyLoads& loads);
/// All forces of rows back to the loads, and how far the threads slid.
/// @param gain  of the rows' values over positions, see setStepTargets(); 1 in an equilibrium
void storeForces(const RowSystem& system, double gain, BodyLoads& loads);

}  // namespace vibe
