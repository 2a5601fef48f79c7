// Marking in whole steps: pedal, beam, heat, events.
#include <gtest/gtest.h>
#include "vibe_testing/allocation_count.hpp"

#include <algorithm>
#include <cstdio>
#include <limits>

#include "procedure/marking.hpp"
#include "procedure/marking_stage.hpp"
#include "vibe_core/arithmetic/rotation.hpp"
#include "vibe_core/simulation/snapshot.hpp"

namespace vibe::marking_step_test {
namespace {

using test::markingScene;
using Stage = test::MarkingStage;
using Kind = Event::Kind;

constexpr double kRadius = test::kStageRadius, kWall = test::kStageWall, kGap = test::kStageGap;

TEST(MarkingStep, TwoSecondsMakeOneMark) {
  Stage stage;
  stage.press(2);
  EXPECT_EQ(stage.count(Kind::Mark), 1);
  EXPECT_EQ(stage.count(Kind::Burn), 0);
  EXPECT_EQ(stage.count(Kind::Rejected), 0);
  EXPECT_NEAR(stage.state.procedure.beam_energy, 80, 1e-6);
  EXPECT_GT(stage.graded(BurnGrade::Mark), 0);
  const Eigen::Vector3d aim(0, 0, -kRadius);
  for (int i = 0; i < stage.model->particle_count; ++i) {
    const double distance = (stage.position(i) - aim).norm();
    const int grade = stage.state.procedure.grade[i];
    EXPECT_TRUE(grade == 0 || distance < 8e-3) << distance;
    EXPECT_TRUE(grade == 1 || distance > 2e-3) << distance;
  }
  for (const Event& event : stage.events) {
    if (event.kind != Kind::Mark) continue;
    const double threshold = ThermalDose(ApcParameters{}).threshold(BurnGrade::Mark);
    EXPECT_GE(event.value, threshold);
    EXPECT_LT(event.value, threshold + 40.0 / 60) << "said in the step in which it came to be";
    EXPECT_LT((stage.model->organ.surface.vertices[event.particle] - aim).norm(), 5e-3);
    EXPECT_NE(describe(event).find("anterior"), std::string::npos) << describe(event);
  }
}

TEST(MarkingStep, ThePhaseBecomesMark) {
  Stage stage;
  stage.release(0.1);
  EXPECT_EQ(stage.state.procedure.phase, Phase::Inspect);
  stage.press(0.1);
  EXPECT_EQ(stage.state.procedure.phase, Phase::Mark);
  EXPECT_EQ(stage.count(Kind::PhaseChanged), 1);
}

TEST(MarkingStep, FifteenSecondsBurnAndTwentyAreNotDeep) {
  Stage stage;
  stage.press(15);
  EXPECT_EQ(stage.count(Kind::Burn), 1) << "one scar, one event";
  stage.press(5);
  EXPECT_EQ(stage.count(Kind::Mark), 1);
  EXPECT_EQ(stage.count(Kind::Burn), 1);
  EXPECT_EQ(stage.count(Kind::DeepBurn), 0);
  EXPECT_GT(stage.graded(BurnGrade::Burn), 0);
  EXPECT_LT(stage.graded(BurnGrade::Burn), stage.graded(BurnGrade::Mark));
  stage.press(30);
  EXPECT_EQ(stage.count(Kind::DeepBurn), 1);
}

TEST(MarkingStep, OutOfReachIsRefusedOnceAndActsWhenItComesNear) {
  Stage stage(markingScene(), 0.02);
  stage.press(1);
  EXPECT_EQ(stage.count(Kind::Rejected), 1);
  EXPECT_EQ(stage.events.front().value, ApcPedal);
  EXPECT_NE(describe(stage.events.front()).find("15.0 mm"), std::string::npos) << describe(stage.events.front());
  EXPECT_EQ(stage.state.procedure.phase, Phase::Inspect);
  EXPECT_EQ(stage.state.procedure.beam_energy, 0);
  EXPECT_EQ(stage.hottest(), 0);
  stage.release(0.1);
  stage.press(0.1);
  EXPECT_EQ(stage.count(Kind::Rejected), 2) << "once per press";
  stage.placeTip(kGap);
  stage.press(2);
  EXPECT_EQ(stage.count(Kind::Rejected), 2);
  EXPECT_EQ(stage.count(Kind::Mark), 1);
}

TEST(MarkingStep, ASceneWithoutMarkingRefusesAndHasNoMemoryForIt) {
  Scene scene = markingScene();
  scene.marking.reset();
  Stage stage(scene);
  stage.press(0.5);
  ASSERT_EQ(stage.count(Kind::Rejected), 1);
  EXPECT_NE(describe(stage.events.front()).find("'marking'"), std::string::npos) << describe(stage.events.front());
  EXPECT_TRUE(stage.state.procedure.dose.empty());
  EXPECT_TRUE(stage.state.procedure.heat.empty());
  EXPECT_TRUE(stage.state.procedure.grade.empty());
  EXPECT_EQ(stage.workspace->marking(), nullptr);
  EXPECT_FALSE(stage.model->dose_law.has_value());
}

TEST(MarkingStep, SleepingTissueIsMarkedAndCools) {
  Stage stage;
  stage.release(1);
  ASSERT_GE(stage.state.solver.rest_steps, 15) << "the tissue sleeps";
  const std::int64_t steps = stage.state.solver.steps;
  stage.press(2);
  EXPECT_EQ(stage.count(Kind::Mark), 1);
  EXPECT_LT(stage.state.solver.steps - steps, 20) << "it was asleep";
  const float hot = stage.hottest(), dose = stage.maxDose();
  EXPECT_EQ(hot, dose);
  stage.release(10);
  EXPECT_NEAR(stage.hottest(), hot * std::exp(-10 * ApcParameters{}.tissue_cooling), 1e-4 * hot);
  EXPECT_EQ(stage.maxDose(), dose);
}

/// Synthetic poses: the beam wherever the test wants it.
void beamAt(Stage& stage, const Eigen::Vector3d& direction, double seconds) {
  std::vector<Eigen::Isometry3d> poses(stage.model->tool->linkCount(), Eigen::Isometry3d::Identity());
  Eigen::Isometry3d& tip = poses[stage.model->tip_link];
  tip.linear() = rotationBetween(Eigen::Vector3d::UnitX(), direction).toRotationMatrix();
  tip.translation() = (kRadius - kWall / 2 - kGap - ApcParameters{}.probe_length) * direction;
  const long steps = std::lround(seconds * 60);
  for (long k = 0; k < steps; ++k)
    updateMarking(*stage.model, poses, {true, k == 0, 0}, stage.state, *stage.workspace->marking(),
                  {stage.state, stage.events});
}

TEST(MarkingStep, ALineIsOneEventAndAnotherSpotAnother) {
  Stage stage;
  for (int k = 0; k <= 40; ++k) {  // 46 mm at 5 mm/s
    const double angle = 0.02 * k;
    beamAt(stage, Eigen::Vector3d(std::cos(angle), std::sin(angle), 0), 0.02 * kRadius / 5e-3);
  }
  EXPECT_GT(stage.graded(BurnGrade::Mark), 15);
  EXPECT_EQ(stage.count(Kind::Mark), 1);
  beamAt(stage, Eigen::Vector3d(0, -1, 0), 2);
  EXPECT_EQ(stage.count(Kind::Mark), 2);
  EXPECT_NE(describe(stage.events.back()).find("2 marks"), std::string::npos) << describe(stage.events.back());
}

TEST(MarkingStep, InsufflationCools) {
  Stage still, cooled;
  const auto cool = [](Stage& stage, double flow) {
    beamAt(stage, Eigen::Vector3d(0, 1, 0), 2);
    std::vector<Eigen::Isometry3d> poses(stage.model->tool->linkCount(), Eigen::Isometry3d::Identity());
    for (int k = 0; k < 600; ++k)
      updateMarking(*stage.model, poses, {false, false, flow}, stage.state, *stage.workspace->marking(),
                    {stage.state, stage.events});
  };
  cool(still, 0);
  cool(cooled, 3 * kLitrePerMinute);
  EXPECT_NEAR(cooled.hottest() / still.hottest(), std::exp(-10 * 3 * ApcParameters{}.insufflation_cooling), 1e-4);
}

TEST(MarkingStep, TheFlowOfTheInsufflatorReachesTheHeat) {
  Scene scene = markingScene();
  scene.gas = GasScene{};
  Stage closed(scene, kGap, 3), blown(scene, kGap, 3);
  for (Stage* stage : {&closed, &blown}) {
    stage->press(2);
    stage->input.buttons[Insufflate] = stage == &blown ? 1 : 0;
  }
  ASSERT_EQ(closed.hottest(), blown.hottest());
  const double gas = blown.state.gas_amount;
  closed.release(1);
  blown.release(1);
  const double litres = (blown.state.gas_amount - gas) / 101325 / 1e-3;
  ASSERT_GT(litres, 0.01);
  EXPECT_NEAR(std::log(closed.hottest() / blown.hottest()), litres * 60 * ApcParameters{}.insufflation_cooling, 1e-5);
}

TEST(MarkingStep, SameBitsOnEveryRun) {
  Stage a(markingScene(), -2e-3, 3), b(markingScene(), -2e-3, 3);
  for (Stage* stage : {&a, &b}) {
    stage->press(1);
    stage->release(0.2);
    stage->press(0.3);
  }
  EXPECT_EQ(hash(a.state), hash(b.state));
  EXPECT_GT(a.hottest(), 0);
}

TEST(MarkingStep, ASnapshotWithinABurnContinuesToTheBit) {
  Stage stage(markingScene(), -11e-3, 3);  // the tip pushes the wall
  stage.press(3);
  EXPECT_TRUE(stage.state.procedure.base_x.empty());
  const std::string file = ::testing::TempDir() + "vibe_marking_step_test.bin";
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

TEST(MarkingStep, ASnapshotOfASceneWithoutMarkingIsAnothers) {
  Scene without = markingScene();
  without.marking.reset();
  Stage stage(without, kGap, 2), other(markingScene(), kGap, 2);
  const std::string file = ::testing::TempDir() + "vibe_marking_step_without.bin";
  saveSnapshot(*stage.model, stage.state, file);
  EXPECT_THROW(loadSnapshot(*other.model, file), std::exception);
  EXPECT_NO_THROW(loadSnapshot(*stage.model, file));
  std::remove(file.c_str());
}

TEST(MarkingStep, RecoveryKeepsMarksAndLosesHeat) {
  Stage stage(markingScene(), kGap, 3);
  stage.press(2);
  const std::vector<float> dose = stage.state.procedure.dose;
  const int marked = stage.graded(BurnGrade::Mark);
  stage.state.x[5] = std::numeric_limits<double>::quiet_NaN();
  stage.input.buttons[ApcPedal] = 0;
  stage.step(stage.input);
  ASSERT_GE(stage.count(Kind::Recovery), 1);
  EXPECT_EQ(stage.state.procedure.dose, dose);
  EXPECT_EQ(stage.graded(BurnGrade::Mark), marked);
  EXPECT_EQ(stage.hottest(), 0);
  stage.press(2);
  EXPECT_GT(stage.hottest(), 0);
}

TEST(MarkingStep, NoMemoryIsAskedForOnceItRuns) {
  if (!VIBE_COUNTS_ALLOCATIONS) GTEST_SKIP() << "a sanitizer brings its own memory";
  Stage stage;
  stage.press(2);
  stage.release(1);
  long before = test::allocations;
  stage.release(1);
  EXPECT_EQ(test::allocations, before);
  stage.press(0.1);
  before = test::allocations;
  stage.press(0.5);
  EXPECT_EQ(test::allocations, before) << "while nothing new happens not with the pedal down either";
}

}  // namespace
}  // namespace vibe::marking_step_test
