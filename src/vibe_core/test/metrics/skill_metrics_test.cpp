#include "vibe_core/metrics/skill_metrics.hpp"

#include <gtest/gtest.h>

#include "procedure/procedure_bench.hpp"
#include "vibe_core/metrics/session_metrics.hpp"
#include "vibe_testing/allocation_count.hpp"

namespace vibe::skill_metrics_test {
namespace {

using Kind = Event::Kind;

class SkillMetricsTest : public ::testing::Test {
 protected:
  test::Bench bench;
  MetricsRecorder recorder{bench.model(), bench.state()};

  const SkillMetrics& skill() const { return recorder.metrics().skill; }

  /// A step in which nothing moves and these things happen.
  void happen(std::initializer_list<Kind> kinds) {
    std::vector<Event> events;
    for (Kind kind : kinds) events.emplace_back().kind = kind;
    recorder.record(bench.model(), bench.state(), false, events);
  }
  /// Acts and records what came of it.
  template <class Act>
  void record(const Act& act) {
    bench.world.events.clear();
    act();
    recorder.record(bench.model(), bench.state(), false, bench.world.events);
  }
};

TEST_F(SkillMetricsTest, beginsWithNothingDone) {
  EXPECT_EQ(skill().bites.taken + skill().marks.zones + skill().bleeding.mild + skill().mistakes.rejected, 0);
  EXPECT_TRUE(skill().sets.empty());
  EXPECT_EQ(skill().phases.whole.time, 0);
}

TEST_F(SkillMetricsTest, countsMistakesFromEvents) {
  happen({Kind::BiteMissed, Kind::BiteMissed, Kind::BiteWithdrawn, Kind::Slip});
  happen({Kind::ThreadBroke, Kind::Rejected, Kind::Rejected, Kind::Rejected, Kind::ContactBegin});
  EXPECT_EQ(skill().mistakes.missed_bites, 2);
  EXPECT_EQ(skill().mistakes.withdrawn_bites, 1);
  EXPECT_EQ(skill().mistakes.slips, 1);
  EXPECT_EQ(skill().mistakes.broken_threads, 1);
  EXPECT_EQ(skill().mistakes.rejected, 3);
}

TEST_F(SkillMetricsTest, followsAWholeSetAsItIsMade) {
  record([&] { bench.bite(0); });
  EXPECT_EQ(skill().bites.taken, 1);
  ASSERT_EQ(skill().sets.size(), 1u);
  EXPECT_FALSE(skill().sets[0].named);
  for (int vertex : {1, 2, 3}) record([&] { bench.bite(vertex); });
  record([&] { bench.press(TTag); });
  EXPECT_TRUE(skill().sets[0].named);
  record([&] { bench.press(Cinch); });
  EXPECT_EQ(skill().sets[0].stage, Suture::Stage::Cinched);
  EXPECT_EQ(skill().sets[0].bites, 4);
  // the tissue of the bench does not move, so the distances of now are those of the rest shape
  const std::vector<Bite>& bites = bench.procedure().sutures[0].bites;
  const State& state = bench.state();
  double distances = 0;
  for (int k = 1; k < 4; ++k)
    distances +=
        (bitePosition(bites[k], state.x, state.y, state.z) - bitePosition(bites[k - 1], state.x, state.y, state.z))
            .norm();
  EXPECT_NEAR(*skill().bites.spacing_mean, distances / 3, 1e-12);
  EXPECT_NEAR(distances / 3, 0.0311, 1e-4) << "31.1 mm measured; the vertices are 31.5 mm apart";
  EXPECT_DOUBLE_EQ(*skill().bites.depth_mean, bench.procedure().sutures[0].bites[0].depth);
  record([&] { bench.bite(5); });
  EXPECT_EQ(skill().sets.size(), 2u);
}

TEST_F(SkillMetricsTest, givesEachStepToItsPhase) {
  const double dt = bench.model().scene.step_period;
  for (int k = 0; k < 5; ++k) {
    for (int n = 0; n <= k; ++n) {
      bench.procedure().phase = static_cast<Phase>(k);
      happen({});
    }
    EXPECT_NEAR(skill().phases.phase[k].time, (k + 1) * dt, 1e-12);
  }
  EXPECT_NEAR(skill().phases.whole.time, 15 * dt, 1e-12);
}

TEST_F(SkillMetricsTest, measuresBleeding) {
  auto& bleedings = bench.procedure().bleedings;
  bleedings.resize(4);
  bleedings[1].rate = 1e-8;
  bleedings[2].brisk = bleedings[3].brisk = true;
  bleedings[3].rate = 2e-7;
  bleedings[3].overdue = true;
  bench.procedure().blood_lost = 3e-6;
  happen({Kind::BleedingOverdue});
  EXPECT_EQ(skill().bleeding.mild, 2);
  EXPECT_EQ(skill().bleeding.brisk, 2);
  EXPECT_EQ(skill().bleeding.now, 2);
  EXPECT_EQ(skill().bleeding.overdue, 1);
  bench.procedure().blood_lost = 4e-6;
  happen({});
  EXPECT_EQ(skill().bleeding.lost, 4e-6);
}

TEST_F(SkillMetricsTest, followsMarksThatGrowWithoutEvents) {
  const auto wait = [&] {
    for (int k = 0; k < std::ceil(0.1 / bench.model().scene.step_period); ++k) happen({});
  };
  std::vector<std::uint8_t>& grade = bench.procedure().grade;
  grade.assign(bench.state().x.size(), 0);
  const auto& triangle = bench.model().organ.surface.triangles[0];
  const auto& apart = bench.model().organ.surface.triangles.back();
  grade[triangle[0]] = 1;
  grade[apart[0]] = 1;
  wait();
  EXPECT_EQ(skill().marks.zones, 2);
  grade[triangle[1]] = 2;  // the same zone, worse
  wait();
  EXPECT_EQ(skill().marks.zones, 2);
  EXPECT_EQ(skill().marks.burns, 1);
  grade.assign(grade.size(), 2);
  wait();
  EXPECT_EQ(skill().marks.zones, 1);
}

TEST_F(SkillMetricsTest, aRestartKeepsWhatTheStateHoldsAndForgetsTheRest) {
  record([&] { bench.bite(0); });
  record([&] { bench.bite(1); });
  happen({Kind::Rejected, Kind::BiteMissed});
  bench.procedure().blood_lost = 1e-6;
  recorder.restart(bench.model(), bench.state());
  EXPECT_EQ(skill().bites.taken, 2);
  EXPECT_EQ(skill().bleeding.lost, 1e-6);
  EXPECT_EQ(skill().mistakes.rejected + skill().mistakes.missed_bites, 0);
  EXPECT_EQ(skill().phases.whole.time, 0);
  const MetricsRecorder fresh(bench.model(), bench.state());
  happen({});
  EXPECT_DOUBLE_EQ(*skill().bites.spacing_mean, *fresh.metrics().skill.bites.spacing_mean);
}

TEST_F(SkillMetricsTest, wholePathIsThatOfTheSession) {
  for (int k = 0; k < 90; ++k) {
    bench.state().joints[Insertion] = 0.001 * k;
    bench.procedure().phase = k < 40 ? Phase::Inspect : Phase::Mark;
    happen({});
  }
  EXPECT_NEAR(recorder.metrics().path_length, 0.089, 1e-9);
  EXPECT_NEAR(skill().phases.whole.motion.path_length, recorder.metrics().path_length, 1e-12);
  EXPECT_NEAR(skill().phases.phase[0].motion.path_length, 0.039, 1e-9);
}

TEST_F(SkillMetricsTest, changesNothingOfTheState) {
  record([&] { bench.bite(0); });
  const std::uint64_t before = hash(bench.state());
  for (int k = 0; k < 200; ++k) happen({Kind::Mark, Kind::PressureReached});
  EXPECT_EQ(hash(bench.state()), before);
}

TEST_F(SkillMetricsTest, asksForNoMemoryInQuietSteps) {
  if (!VIBE_COUNTS_ALLOCATIONS) GTEST_SKIP() << "a sanitizer brings its own memory";
  for (int k = 0; k < 4; ++k) record([&] { bench.bite(k); });
  SkillRecorder quiet(SkillInstruments(bench.model()), bench.model(), bench.state(), Eigen::Vector3d::Zero());
  const std::vector<Event> none;
  const auto steps = [&](int count) {
    for (int k = 0; k < count; ++k) {
      // to and fro with rests, through all phases
      const Eigen::Vector3d tip(k / 60 % 2 == 0 ? 0.03 * std::sin(0.2 * k) : 0.0, 0, 0);
      bench.procedure().phase = static_cast<Phase>(k / 100 % kPhaseCount);
      quiet.record(bench.model(), bench.state(), tip, none, EventCounts());
    }
  };
  steps(1200);
  const long before = test::allocations;
  steps(1200);
  EXPECT_EQ(test::allocations, before);
}

}  // namespace
}  // namespace vibe::skill_metrics_test
