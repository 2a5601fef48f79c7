#include "vibe_core/trainee/trainee.hpp"

#include <gtest/gtest.h>

#include "vibe_core/files/files.hpp"
#include "vibe_core/scene/scene_parser.hpp"
#include "vibe_core/simulation/simulation.hpp"

namespace vibe::goal_outcomes_test {
namespace {

std::shared_ptr<const Model> stomach() {
  const Scene scene = loadScene(std::string(VIBE_CORE_DIR) + "/scenes/stomach.yaml");
  return buildModel(scene, readTextFile(std::string(VIBE_DESCRIPTION_DIR) + "/urdf/scope.urdf", "URDF"));
}

TEST(GoalOutcomes, countWhatWasReached) {
  const std::shared_ptr<const Model> model = stomach();
  Simulation simulation(model);
  Trainee trainee(model, Skill::expert(), 1);
  trainee.add(WaitGoal{0.05});
  trainee.cancel(trainee.add(WaitGoal{5}));
  trainee.add(WaitGoal{60});
  while (simulation.time() < 0.5) simulation.step(trainee.next(observe(simulation)));
  const std::vector<GoalOutcome> outcomes = goalOutcomes(trainee);
  ASSERT_EQ(outcomes.size(), 3U);
  EXPECT_TRUE(outcomes[0].reached);
  EXPECT_FALSE(outcomes[1].reached);
  EXPECT_NE(outcomes[1].reason, "");
  EXPECT_FALSE(outcomes[2].reached);
  EXPECT_EQ(outcomes[2].reason, "not ended");
  const std::vector<Measure> measures = goalMeasures(&trainee, {});
  EXPECT_EQ(valueOf(measures, "goals"), 3.0);
  EXPECT_EQ(valueOf(measures, "goals_reached"), 1.0);
}

TEST(GoalOutcomes, aSetIsAsPlannedIfItsTechniqueIsThatOfItsGoal) {
  Trainee trainee(stomach(), Skill::expert(), 1);
  trainee.add(WaitGoal{});
  SutureSetGoal goal;
  for (const Technique pattern : {Technique::U, Technique::U, Technique::Z}) {
    goal.pattern = pattern;
    trainee.add(goal);
  }
  std::vector<SetSkill> sets(3);
  sets[0].named = sets[1].named = true;
  sets[0].technique = Technique::U;
  sets[1].technique = Technique::Z;
  sets[2].technique = Technique::Z;  // no T-tag: not yet recognised
  EXPECT_EQ(valueOf(goalMeasures(&trainee, sets), "sets_as_planned"), 1.0);
}

TEST(GoalOutcomes, bitesOfGoalsThatHaveEndedWithoutThemAreGivenUp) {
  const std::shared_ptr<const Model> model = stomach();
  Simulation simulation(model);
  Trainee trainee(model, Skill::expert(), 1);
  SutureSetGoal set;
  set.bites = 7;
  trainee.cancel(trainee.add(set));
  trainee.cancel(trainee.add(BiteGoal{}));
  trainee.add(WaitGoal{0.05});
  trainee.add(WaitGoal{60});
  trainee.add(set);  // not begun: neither taken nor given up
  while (simulation.time() < 0.5) simulation.step(trainee.next(observe(simulation)));
  EXPECT_EQ(valueOf(goalMeasures(&trainee, {}), "bites_planned"), 8.0);
  EXPECT_EQ(valueOf(goalMeasures(&trainee, {}), "bites_given_up"), 8.0);
}

TEST(GoalOutcomes, withoutATraineeHaveNamesButNoValues) {
  const std::vector<Measure> measures = goalMeasures(nullptr, {});
  for (const char* name : {"goals", "goals_reached", "sets_as_planned", "bites_planned", "bites_given_up"})
    EXPECT_FALSE(valueOf(measures, name)) << name;
}

}  // namespace
}  // namespace vibe::goal_outcomes_test
