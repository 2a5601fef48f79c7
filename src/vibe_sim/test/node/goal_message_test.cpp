// Goals of messages have the ranges, defaults and sentences of protocols.
#include "conversions/goal_message.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "sentences.hpp"
#include "vibe_core/simulation/simulation.hpp"

namespace vibe::sim::goal_message_test {
namespace {

vibe_msgs::TraineeGoal message(const std::string& kind) {
  vibe_msgs::TraineeGoal goal;
  goal.kind = kind;
  return goal;
}

std::string errorOf(const vibe_msgs::TraineeGoal& goal) {
  return sentenceOf([&] { readGoal(goal); });
}

TEST(GoalMessage, ABiteHasItsPlaceToTheBit) {
  vibe_msgs::TraineeGoal goal = message("bite");
  goal.along = 0.1 + 0.2;
  goal.around = -1. / 3;
  goal.distal = 0.01 / 7;
  goal.anterior = -2e-3;
  const Place place = std::get<BiteGoal>(readGoal(goal)).place;
  EXPECT_EQ(place.along, goal.along);
  EXPECT_EQ(place.around, goal.around);
  EXPECT_EQ(place.distal, goal.distal);
  EXPECT_EQ(place.anterior, goal.anterior);
  goal.along = 0;  // is a place, not a default
  EXPECT_EQ(std::get<BiteGoal>(readGoal(goal)).place.along, 0);
}

TEST(GoalMessage, ZeroStandsForTheDefault) {
  const auto set = std::get<SutureSetGoal>(readGoal(message("suture_set")));
  const SutureSetGoal usual;
  EXPECT_EQ(set.pattern, usual.pattern);
  EXPECT_EQ(set.bites, usual.bites);
  EXPECT_EQ(set.length, usual.length);
  EXPECT_EQ(set.width, usual.width);
  EXPECT_TRUE(set.cinched);
  EXPECT_EQ(std::get<MarkGoal>(readGoal(message("mark"))).time, MarkGoal{}.time);
  EXPECT_EQ(std::get<InsufflateGoal>(readGoal(message("insufflate"))).patience, InsufflateGoal{}.patience);
}

TEST(GoalMessage, InspectIsOfAPlaceOrOfSoMuchOfTheWall) {
  vibe_msgs::TraineeGoal goal = message("inspect");
  goal.along = 0.3;
  goal.time = 7;
  EXPECT_EQ(std::get<InspectGoal>(readGoal(goal)).place.along, 0.3);
  EXPECT_EQ(std::get<InspectGoal>(readGoal(goal)).time, 7);
  goal.coverage = 0.8;
  goal.region = "antrum";
  const auto survey = std::get<SurveyGoal>(readGoal(goal));
  EXPECT_EQ(survey.coverage, 0.8);
  EXPECT_EQ(survey.region, Region::Antrum);
  EXPECT_EQ(survey.patience, 7);
  EXPECT_EQ(survey.distance, SurveyGoal{}.distance);
  goal.coverage = 1.5;
  EXPECT_NE(errorOf(goal).find("coverage"), std::string::npos);
}

TEST(GoalMessage, ASetHasAllItsFields) {
  vibe_msgs::TraineeGoal goal = message("suture_set");
  goal.along = 0.4;
  goal.pattern = "z";
  goal.bites = 9;
  goal.length = 0.02;
  goal.width = 0.05;
  goal.mirrored = goal.leave_open = 1;
  const auto set = std::get<SutureSetGoal>(readGoal(goal));
  EXPECT_EQ(set.centre.along, 0.4);
  EXPECT_EQ(set.pattern, Technique::Z);
  EXPECT_EQ(set.bites, 9);
  EXPECT_EQ(set.length, 0.02);
  EXPECT_EQ(set.width, 0.05);
  EXPECT_TRUE(set.mirrored);
  EXPECT_FALSE(set.cinched);
  EXPECT_EQ(patternOf(set), "z");
  EXPECT_EQ(patternOf(readGoal(message("cinch"))), "");
}

TEST(GoalMessage, TimesAndInsertionReachTheirGoals) {
  vibe_msgs::TraineeGoal goal = message("wait");
  goal.time = 3.5;
  goal.insertion = 0.07;
  EXPECT_EQ(std::get<WaitGoal>(readGoal(goal)).time, 3.5);
  goal.kind = "mark";
  EXPECT_EQ(std::get<MarkGoal>(readGoal(goal)).time, 3.5);
  goal.kind = "insufflate";
  EXPECT_EQ(std::get<InsufflateGoal>(readGoal(goal)).patience, 3.5);
  goal.kind = "withdraw";
  EXPECT_EQ(std::get<WithdrawGoal>(readGoal(goal)).insertion, 0.07);
}

TEST(GoalMessage, WhatIsWrongIsNamedInOneSentence) {
  const auto expect = [](const vibe_msgs::TraineeGoal& goal, const std::string& word) {
    const std::string error = errorOf(goal);
    EXPECT_NE(error.find(word), std::string::npos) << error;
    EXPECT_EQ(error.find('\n'), std::string::npos) << error;
    EXPECT_EQ(error.find("goals[0]"), std::string::npos) << error;
  };
  vibe_msgs::TraineeGoal goal = message("bite");
  EXPECT_EQ(errorOf(goal), "");
  goal.along = 1.4;
  expect(goal, "bite.along: '1.4");
  goal.along = std::numeric_limits<double>::quiet_NaN();
  expect(goal, "not finite");
  goal.along = -std::numeric_limits<double>::infinity();
  expect(goal, "not finite");
  goal = message("bite");
  goal.around = 4;
  expect(goal, "bite.around");
  expect(message("byte"), "did you mean 'bite'");
  expect(message(""), "no kind");
  expect(message("sleeve"), "row of goals");
  expect(message("bite: {along: 1}, wait"), "is not a goal");
  goal = message("suture_set");
  goal.pattern = "w";
  expect(goal, "known are u, z");
  goal.pattern = "u, bites: 9";
  expect(goal, "known are u, z");
  goal.pattern = "square";
  goal.bites = 4;
  expect(goal, "does not exist");
  goal = message("wait");
  goal.time = -1;
  expect(goal, "wait.for");
}

std::string refusalOf(const Model& model, const vibe_msgs::TraineeGoal& goal) {
  return refusalIn(model, goal, readGoal(goal));
}

TEST(GoalMessage, APlaceMayBeAShareOfARegion) {
  vibe_msgs::TraineeGoal goal = message("bite");
  EXPECT_FALSE(std::get<BiteGoal>(readGoal(goal)).place.region);
  goal.region = "body";
  goal.along = 0.5;
  EXPECT_EQ(std::get<BiteGoal>(readGoal(goal)).place.region, Region::Body);
  goal.region = "bulb";
  EXPECT_NE(errorOf(goal).find("bite.region"), std::string::npos) << errorOf(goal);
}

TEST(GoalMessage, ARegionThatTheOrganLacksIsARefusal) {
  const auto model = std::const_pointer_cast<Model>(vibe::loadModel("node/scenes/small_stomach.yaml"));
  vibe_msgs::TraineeGoal goal = message("bite");
  goal.region = "antrum";
  goal.along = 0.5;
  EXPECT_EQ(refusalOf(*model, goal), "");
  for (Region& region : model->organ.region)
    if (region == Region::Antrum) region = Region::Body;
  EXPECT_NE(refusalOf(*model, goal).find("antrum"), std::string::npos) << refusalOf(*model, goal);
}

TEST(GoalMessage, WhatASceneLacksIsARefusal) {
  const std::shared_ptr<const Model> stomach = vibe::loadModel("node/scenes/small_stomach.yaml");
  for (const char* kind : {"insufflate", "bite", "suture_set", "cinch", "withdraw", "wait"})
    EXPECT_EQ(refusalOf(*stomach, message(kind)), "") << kind;
  EXPECT_NE(refusalOf(*stomach, message("mark")).find("'marking'"), std::string::npos);
  const std::shared_ptr<const Model> ball = vibe::loadModel("node/scenes/balloon.yaml");
  EXPECT_FALSE(refusalOf(*ball, message("bite")).empty()) << "a ball has no anatomy";
  EXPECT_EQ(refusalOf(*ball, message("wait")), "");
}

}  // namespace
}  // namespace vibe::sim::goal_message_test
