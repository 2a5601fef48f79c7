#include "vibe_core/metrics/session_metrics.hpp"

#include <gtest/gtest.h>

#include "procedure/procedure_bench.hpp"
#include "vibe_core/metrics/session_report.hpp"

namespace vibe::session_metrics_test {
namespace {

using Kind = Event::Kind;

class SessionMetricsTest : public ::testing::Test {
 protected:
  test::Bench bench;
  MetricsRecorder recorder{bench.model(), bench.state()};
  const double dt = bench.model().scene.step_period;

  const SessionMetrics& metrics() const { return recorder.metrics(); }
  void step(std::initializer_list<Kind> kinds = {}, bool insufflator_on = false) {
    std::vector<Event> events;
    for (Kind kind : kinds) events.emplace_back().kind = kind;
    bench.state().time += dt;
    recorder.record(bench.model(), bench.state(), insufflator_on, events);
  }
};

TEST_F(SessionMetricsTest, addsUpTimesOfWhatIsDone) {
  for (int k = 0; k < 12; ++k) {
    bench.state().contact_count = k < 3 ? 1 : 0;
    bench.state().grip.resize(k < 5 ? 1 : 0);
    step({}, k < 7);
  }
  EXPECT_NEAR(metrics().time, 12 * dt, 1e-12);
  EXPECT_NEAR(metrics().contact_time, 3 * dt, 1e-12);
  EXPECT_NEAR(metrics().grip_time, 5 * dt, 1e-12);
  EXPECT_NEAR(metrics().insufflation_time, 7 * dt, 1e-12);
}

TEST_F(SessionMetricsTest, pathIsThatOfTheTip) {
  for (double insertion : {0.02, 0.05, 0.03}) {
    bench.state().joints[Insertion] = insertion;
    step();
  }
  EXPECT_NEAR(metrics().path_length, 0.07, 1e-9);
}

TEST_F(SessionMetricsTest, meanForceIsOverTheTimeWithAForce) {
  for (double force : {0.0, 2.0, 4.0, 0.0, 0.0}) {
    bench.state().tool_force = Eigen::Vector3d(0, force, 0);
    step();
  }
  EXPECT_DOUBLE_EQ(metrics().max_force, 4);
  EXPECT_NEAR(metrics().mean_force, 3, 1e-12);
  EXPECT_NEAR(*metrics().skill.phases.whole.force.mean, 3, 1e-12);
}

TEST_F(SessionMetricsTest, keepsTheMaxVolumeAndPressure) {
  for (double factor : {1.0, 3.0, 2.0}) {
    bench.state().volume = factor * 1e-4;
    bench.state().pressure = factor * 100;
    step();
  }
  EXPECT_DOUBLE_EQ(metrics().volume, 2e-4);
  EXPECT_DOUBLE_EQ(metrics().max_volume, 3e-4);
  EXPECT_DOUBLE_EQ(metrics().pressure, 200);
  EXPECT_DOUBLE_EQ(metrics().max_pressure, 300);
}

TEST_F(SessionMetricsTest, countsEventsByKind) {
  step({Kind::Grab, Kind::Grab, Kind::Grab, Kind::GrabMissed, Kind::Release, Kind::Release});
  step({Kind::Slip, Kind::Warning, Kind::Recovery, Kind::Bite, Kind::PhaseChanged});
  EXPECT_EQ(metrics().events.of(Kind::Grab), 3);
  EXPECT_EQ(metrics().events.of(Kind::GrabMissed), 1);
  EXPECT_EQ(metrics().events.of(Kind::Release), 2);
  EXPECT_EQ(metrics().events.of(Kind::Slip), 1);
  EXPECT_EQ(metrics().events.of(Kind::BiteMissed), 0);
  EXPECT_EQ(metrics().warnings(), 2);
  EXPECT_EQ(metrics().events.total(), 11);
}

TEST_F(SessionMetricsTest, aRestartIsAsGoodAsANewOne) {
  bench.state().joints[Insertion] = 0.05;
  step({Kind::Grab, Kind::Rejected});
  bench.bite(0);
  recorder.restart(bench.model(), bench.state());
  MetricsRecorder fresh(bench.model(), bench.state());
  bench.state().joints[Insertion] = 0.08;
  step({Kind::Grab});
  std::vector<Event> events(1);
  events[0].kind = Kind::Grab;
  fresh.record(bench.model(), bench.state(), false, events);
  EXPECT_EQ(metrics().events.of(Kind::Grab), 1);
  EXPECT_EQ(metrics().events.total(), 1);
  EXPECT_EQ(summarise(metrics()), summarise(fresh.metrics()));
}

TEST_F(SessionMetricsTest, theSummaryEndsWithTheHash) {
  step();
  const std::string text = runSummary(metrics(), DurationHistogram(), 42, 1, 2, 0x1234);
  EXPECT_EQ(text.rfind("state hash: 0000000000001234\n"), text.size() - 29);
  for (const char* part : {"simulated time", "phase  ", "whole", "marks", "bites", "sets", "bleeding", "mistakes",
                           "organ", "solver per step", "real-time factor       0.50"})
    EXPECT_NE(text.find(part), std::string::npos) << part;
}

}  // namespace
}  // namespace vibe::session_metrics_test
