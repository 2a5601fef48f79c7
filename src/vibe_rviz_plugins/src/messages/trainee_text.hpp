#pragma once
#include <vibe_msgs/TraineeProgress.h>

#include <string>

namespace vibe::rviz_plugins {

/// What a trainee does and how far it is, in a few lines: the goal that is pursued, or how many have ended; what is
/// being done; why the last failed goal failed.
std::string traineeText(const vibe_msgs::TraineeProgress& progress);

}  // namespace vibe::rviz_plugins
