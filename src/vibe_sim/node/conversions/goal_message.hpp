#pragma once

#include <string>

#include <vibe_msgs/TraineeGoal.h>

#include "vibe_core/model/model.hpp"
#include "vibe_core/trainee/protocol.hpp"

namespace vibe::sim {

/// The goal of a message, with the ranges and defaults of a protocol.
/// @throws Error with one sentence if it is no goal: an unknown kind or pattern, a value that is not finite or out of
///         range, a pattern that does not exist
Goal readGoal(const vibe_msgs::TraineeGoal& message);

/// Why a goal cannot be reached in a scene at all, in one sentence: something is missing in the scene, or the organ
/// lacks the place. Empty: it may be reached.
/// @param goal  that of the message
std::string refusalIn(const Model& model, const vibe_msgs::TraineeGoal& message, const Goal& goal);

/// Pattern of a suture set; empty for other goals.
std::string patternOf(const Goal& goal);

}  // namespace vibe::sim
