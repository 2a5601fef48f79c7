// Marking in the gradient domain in whole steps.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>

#include "gradient/marking_touch.hpp"
#include "procedure/marking_stage.hpp"
#include "vibe_core/simulation/snapshot.hpp"

namespace vibe::prototype::marking_gradient_test {
namespace {

using test::markingScene;
using Stage = test::MarkingStage;
using Kind = Event::Kind;

constexpr double kGap = test::kStageGap;

Scene gradientScene() {
  Scene scene = markingScene();
  scene.marking->deformation = "gradient";
  return scene;
}

/// How far the fastest particle goes in a step.
double largestMove(Stage& stage) {
  const State before = stage.state;
  stage.step(stage.input);
  double largest = 0;
  for (int i = 0; i < stage.model->particle_count; ++i)
    largest = std::max(largest, (stage.position(i) - Eigen::Vector3d(before.x[i], before.y[i], before.z[i])).norm());
  return largest;
}

TEST(MarkingGradient, SameBitsOnEveryRun) {
  Stage a(gradientScene(), -2e-3, 3), b(gradientScene(), -2e-3, 3);
  for (Stage* stage : {&a, &b}) {
    stage->press(1);
    stage->release(0.2);
    stage->press(0.3);
  }
  EXPECT_EQ(hash(a.state), hash(b.state));
  EXPECT_GT(a.hottest(), 0);
}

TEST(MarkingGradient, ASnapshotWithinABurnContinuesToTheBit) {
  Stage stage(gradientScene(), -11e-3, 3);  // the tip pushes the wall
  stage.press(3);
  EXPECT_FALSE(stage.state.procedure.base_x.empty());
  const std::string file = ::testing::TempDir() + "vibe_marking_gradient_test.bin";
  saveSnapshot(*stage.model, stage.state, file);
  State loaded = loadSnapshot(*stage.model, file);
  std::remove(file.c_str());
  ASSERT_EQ(hash(loaded), hash(stage.state));
  Workspace other(*stage.model);
  std::vector<Event> events;
  for (int k = 0; k < 700; ++k) {
    stage.input.buttons[ApcPedal] = k < 600 ? 1 : 0;
    stage.step(stage.input);
    step(*stage.model, loaded, stage.input, other, events);
    ASSERT_EQ(hash(loaded), hash(stage.state)) << "step " << k;
  }
  EXPECT_GT(stage.graded(BurnGrade::Burn), 0);
}

TEST(MarkingGradient, FollowsTheToolAndHandsBackWithoutAJump) {
  Stage stage(gradientScene(), -5e-3);
  stage.press(0.5);
  EXPECT_FALSE(stage.state.procedure.base_x.empty());
  stage.placeTip(-14e-3);  // 4 mm into the wall
  for (int k = 0; k < 60; ++k) EXPECT_LT(largestMove(stage), 3.5e-3) << "as fast as the tool, 2.5 mm a step";
  EXPECT_GT(stage.maxShift(), 2e-3);
  EXPECT_LT(stage.maxShift(), 6e-3);
  EXPECT_GT(stage.state.contact_count, 0);
  EXPECT_EQ(stage.state.tool_force.norm(), 0) << "shape without mechanics";
  EXPECT_EQ(*std::max_element(stage.state.vz.begin(), stage.state.vz.end()), 0);
  const double pushed = stage.maxShift();
  stage.input.buttons[ApcPedal] = 0;
  for (int k = 0; k < 60; ++k) EXPECT_LT(largestMove(stage), 1e-3) << k;
  EXPECT_TRUE(stage.state.procedure.base_x.empty());
  EXPECT_GT(stage.state.tool_force.norm(), 0.01) << "the shell takes over and is felt";
  EXPECT_NEAR(stage.maxShift(), pushed, 1e-3) << "the tool is still there";
  EXPECT_EQ(stage.count(Kind::Recovery), 0);
}

TEST(MarkingGradient, SpringsBackWhereTheToolLeavesAndTheSolverAgreesWhereNothingIsTouched) {
  Stage gradient(gradientScene(), -13e-3), solver(markingScene(), -13e-3);
  for (Stage* stage : {&gradient, &solver}) {
    stage->press(0.5);
    stage->placeTip(kGap);
    stage->press(1);
  }
  EXPECT_GT(gradient.graded(BurnGrade::Mark), 0);
  const State base = gradient.state;
  EXPECT_EQ(base.x, base.procedure.base_x) << "to the bit";
  EXPECT_LT(gradient.maxShift(), 1e-9);
  EXPECT_TRUE(solver.state.procedure.base_x.empty());
}

TEST(MarkingGradient, APedalThatComesDownAgainAtOnceFindsThePresentWall) {
  Stage stage(gradientScene(), -5e-3);
  stage.placeTip(-14e-3);
  stage.press(1);
  const double old_base = stage.state.procedure.base_z[0];
  stage.input.buttons[ApcPedal] = 0;
  stage.step(stage.input);
  ASSERT_FALSE(stage.state.procedure.base_x.empty()) << "the solver still takes it over";
  EXPECT_EQ(stage.state.procedure.base_x, stage.state.x);
  EXPECT_NE(stage.state.procedure.base_z[0], old_base);
  stage.input.buttons[ApcPedal] = 1;
  EXPECT_LT(largestMove(stage), 1e-3);
}

TEST(MarkingGradient, ACinchThatDrawsNeedsTheSolver) {
  Stage stage(gradientScene(), kGap, 2);
  stage.press(0.1);
  EXPECT_FALSE(stage.state.procedure.base_x.empty());
  stage.state.procedure.sutures.emplace_back().stage = Suture::Stage::Cinching;
  stage.press(0.1);
  EXPECT_TRUE(stage.state.procedure.base_x.empty());
}

TEST(MarkingGradient, TissueThatIsPulledNeedsTheSolver) {
  State state;
  EXPECT_TRUE(MarkingTouch::mayReplaceSolver(state));
  state.pull.node = {0};
  EXPECT_FALSE(MarkingTouch::mayReplaceSolver(state));
}

TEST(MarkingGradient, GasStaysInAndIsCompressed) {
  Scene scene = gradientScene();
  scene.gas = GasScene{};
  scene.gas->initial_pressure = 500;
  Stage stage(scene, 5e-3);
  stage.release(1);
  const double amount = stage.state.gas_amount;
  stage.placeTip(-13.5e-3);
  stage.input.buttons[Insufflate] = 1;
  stage.press(1);
  EXPECT_EQ(stage.state.gas_amount, amount) << "the insufflator pauses";
  EXPECT_NEAR((stage.state.pressure + 101325) * stage.state.volume, amount, 1e-9 * amount);
}

}  // namespace
}  // namespace vibe::prototype::marking_gradient_test
