#pragma once

#include "solver/stepper_workspace.hpp"
#include "solver/time_scheme.hpp"

namespace vibe {

/// The constraints, contacts and threads of the loads as rows for the positions at which forces are evaluated, in the
/// scratch's rows. The lengths of segments of thread are linearised about the given positions.
void buildRows(const BodyLoads& loads, const MotionView& motion, StepperWorkspace& scratch);
/// The values that the rows have in the equilibrium itself, in the scratch's target.
void setEquilibriumTargets(const BodyLoads& loads, StepperWorkspace& scratch);
/// The same for a step: rows are met at its end, so that z has to move by the scheme's ratio of gains times as much.
/// Scales the compliances of the rows in the same way.
/// @param in_factor  stiffness that the factor has beside that of the elements
void setStepTargets(const BodyLoads& loads, const MotionView& motion, const TimeScheme& scheme,
                    const std::vector<StiffnessCoupling>& in_factor, StepperWorkspace& scratch);
/// Bounds the work of a step: the deepest contacts at the scratch's z keep their friction, further ones only their
/// normal, and the rest has no force. Needs the targets.
void limitContacts(StepperWorkspace& scratch);
/// The rows' forces back to the loads, and how far the threads slid.
/// @param gain  of the rows' values over positions, see setStepTargets(); 1 in an equilibrium
void storeForces(const StepperWorkspace& scratch, double gain, BodyLoads& loads);

}  // namespace vibe
