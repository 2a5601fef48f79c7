#include "vibe_operator/messages/procedure_text.hpp"

#include <gtest/gtest.h>

namespace vibe::operating::trainee_text_test {
namespace {

using Goal = vibe_msgs::GoalProgress;

void add(const std::string& goal, std::uint8_t state, vibe_msgs::TraineeProgress& progress) {
  progress.goals.emplace_back().goal = goal;
  progress.goals.back().state = state;
}

TEST(TraineeText, NoGoals) {
  vibe_msgs::TraineeProgress progress;
  EXPECT_EQ(traineeText(progress), "no goals");
  progress.skill = "novice";
  EXPECT_EQ(traineeText(progress), "novice: no goals");
}

TEST(TraineeText, WhatIsDoneAndWhatFailed) {
  vibe_msgs::TraineeProgress progress;
  progress.skill = "expert";
  add("insufflate", Goal::REACHED, progress);
  add("mark", Goal::FAILED, progress);
  progress.goals.back().reason = "the scene has no argon beam";
  add("bite", Goal::ACTIVE, progress);
  progress.goals.back().label = "mine";
  progress.goals.back().activity = "try 2 of 5";
  add("withdraw", Goal::QUEUED, progress);
  EXPECT_EQ(traineeText(progress),
            "expert: 1 reached, 1 failed, 1 queued\n"
            "Now: bite (mine), try 2 of 5\n"
            "Last failed: mark: the scene has no argon beam");
  progress.goals[2].activity = "bite";  // says nothing new
  progress.goals[2].label.clear();
  EXPECT_NE(traineeText(progress).find("Now: bite\n"), std::string::npos);
}

}  // namespace
}  // namespace vibe::operating::trainee_text_test
