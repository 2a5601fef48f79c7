#include "vibe_core/simulation/stage_summary.hpp"

#include <gtest/gtest.h>

#include "vibe_core/simulation/simulation.hpp"
#include "vibe_testing/scope_worlds.hpp"

namespace vibe::stage_summary_test {
namespace {

using namespace test;

void spend(double seconds) {
  for (const double end = threadCpuTime() + seconds; threadCpuTime() < end;) {
  }
}

TEST(StageClock, TimeBelongsToTheInnermostStage) {
  StageClock clock;
  clock.start();
  {
    const InStage rows(&clock, StepStage::Rows);
    spend(2e-3);
    const InStage walls(&clock, StepStage::Walls);
    spend(5e-3);
  }
  const StageTimes times = clock.stop();
  const auto of = [&](StepStage stage) { return times[static_cast<std::size_t>(stage)]; };
  EXPECT_GE(of(StepStage::Rows), 2e-3);
  EXPECT_GE(of(StepStage::Walls), 5e-3);
  EXPECT_LT(of(StepStage::Rows), of(StepStage::Walls));
  EXPECT_EQ(of(StepStage::Energy), 0);
}

std::shared_ptr<const Model> shell() {
  Scene scene;
  scene.geometry.particles = 300;
  return buildModel(scene, "");
}

TEST(StageSummary, StagesMakeUpTheStepAndChangeNothing) {
  SimulationSettings settings;
  Simulation plain(shell(), settings);
  settings.stages = true;
  Simulation measured(plain.sharedModel(), settings);
  for (int k = 0; k < 20; ++k) plain.step(StepInput()), measured.step(StepInput());
  EXPECT_EQ(plain.stages(), nullptr);
  EXPECT_EQ(plain.hash(), measured.hash());
  const StageSummary& stages = *measured.stages();
  EXPECT_EQ(stages.whole().count(), 20U);
  double sum = 0;
  for (int k = 0; k < kStepStages; ++k) sum += stages.stage(static_cast<StepStage>(k)).mean();
  EXPECT_NEAR(sum, stages.whole().mean(), 1e-9);
  EXPECT_LE(stages.whole().mean(), measured.timer().cpu.all.mean());
  EXPECT_GT(stages.stage(StepStage::Energy).mean(), 0);
  EXPECT_GT(stages.stage(StepStage::Inverse).mean(), 0);
  EXPECT_NE(stages.text().find("inverse"), std::string::npos);
}

}  // namespace
}  // namespace vibe::stage_summary_test
