#pragma once

#include "solver/time_scheme.hpp"

namespace vibe {

class StepperScratch;

/// Moves the nodes to the end of the step and sums up the works. Sets the works of the loads.
StepWork finishMotion(const ElasticBody& body, const TimeScheme& scheme, const MotionView& motion, BodyLoads& loads,
                      StepperScratch& scratch);

}  // namespace vibe
