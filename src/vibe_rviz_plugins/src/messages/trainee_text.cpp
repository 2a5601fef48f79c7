#include "messages/trainee_text.hpp"

#include <algorithm>

namespace vibe::rviz_plugins {
namespace {

using Goal = vibe_msgs::GoalProgress;

std::string nameOf(const Goal& goal) {
  return goal.label.empty() ? goal.goal : goal.goal + " (" + goal.label + ")";
}

std::string countsText(const vibe_msgs::TraineeProgress& progress) {
  const auto count = [&progress](std::uint8_t state) {
    return std::to_string(std::count_if(progress.goals.begin(), progress.goals.end(),
                                        [state](const Goal& goal) { return goal.state == state; }));
  };
  std::string text =
      count(Goal::REACHED) + " reached, " + count(Goal::FAILED) + " failed, " + count(Goal::QUEUED) + " queued";
  return progress.skill.empty() ? text : progress.skill + ": " + text;
}

}  // namespace

std::string traineeText(const vibe_msgs::TraineeProgress& progress) {
  if (progress.goals.empty()) return progress.skill.empty() ? "no goals" : progress.skill + ": no goals";
  std::string text = countsText(progress);
  const Goal* failed = nullptr;
  for (const Goal& goal : progress.goals) {
    if (goal.state == Goal::FAILED) failed = &goal;
    if (goal.state != Goal::ACTIVE) continue;
    text += "\nNow: " + nameOf(goal);
    if (!goal.activity.empty() && goal.activity != goal.goal) text += ", " + goal.activity;
  }
  if (failed) text += "\nLast failed: " + nameOf(*failed) + ": " + failed->reason;
  return text;
}

}  // namespace vibe::rviz_plugins
