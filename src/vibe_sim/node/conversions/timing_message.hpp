#pragma once
#include <vibe_msgs/StepTiming.h>

#include "vibe_core/model/tissue_solver.hpp"

namespace vibe::sim {

/// Stages and counts of a step, into the fields of the message that have them.
void setWork(const StepReport& report, vibe_msgs::StepTiming& message);

}  // namespace vibe::sim
