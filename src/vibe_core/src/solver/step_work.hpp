#pragma once

#include "solver/stepper_workspace.hpp"
#include "solver/time_scheme.hpp"

namespace vibe {

/// Moves the nodes to the end of the step and sums up the works. Sets the works of the loads.
/// @param mean_velocity  the nodes end with the mean velocity of the step and no acceleration: what iterations that
///                       ended early lack would be amplified by the velocity of the scheme
StepWork finishMotion(const ElasticBody& body, const TimeScheme& scheme, const MotionView& motion, BodyLoads& loads,
                      bool mean_velocity, StepperWorkspace& scratch);

}  // namespace vibe
