#pragma once

#include "solver/stepper_workspace.hpp"
#include "solver/time_scheme.hpp"

namespace vibe {

/// Moves the scratch's z of a free body rigidly by what its velocities and accelerations make of it: however far, that
/// does not strain. The translation and the turn have the linear and angular momentum of the nodes' own moves.
void moveRigidly(const ElasticBody& body, const MotionView& motion, const TimeScheme& scheme,
                 StepperWorkspace& scratch);

}  // namespace vibe
