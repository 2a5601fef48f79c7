#include "vibe_core/metrics/skill_phases.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "metrics/motions.hpp"

namespace vibe::skill_phases_test {
namespace {

constexpr double kPeriod = 1.0 / 60;

class PhaseSkillTest : public ::testing::Test {
 protected:
  PhaseRecorder recorder{std::make_shared<SpectralArcLength>(MotionRecorder::kLongestMovement)};
  Eigen::Vector3d tip = Eigen::Vector3d::Zero();

  void SetUp() override { recorder.start(tip, kPeriod); }

  /// A minimum-jerk reach and half a second of rest.
  void reach(Phase phase, double length, double duration, double force = 0) {
    const Eigen::Vector3d from = tip;
    for (int k = 1; k <= std::lround(duration / kPeriod); ++k) {
      const double s = k * kPeriod / duration;
      tip = from + length * s * s * s * (10 - 15 * s + 6 * s * s) * Eigen::Vector3d::UnitX();
      recorder.record(phase, tip, force, kPeriod);
    }
    for (int k = 0; k < 30; ++k) recorder.record(phase, tip, 0, kPeriod);
  }
  const PhaseSkill& of(Phase phase) const { return recorder.measures().phase[static_cast<int>(phase)]; }
  const PhaseSkill& whole() const { return recorder.measures().whole; }
};

TEST_F(PhaseSkillTest, ofAReachInEachOfTwoPhases) {
  reach(Phase::Mark, 0.1, 2, 2.0);
  reach(Phase::Suture, 0.05, 1, 6.0);
  EXPECT_NEAR(of(Phase::Mark).time, 2.5, 1e-9);
  EXPECT_NEAR(of(Phase::Suture).time, 1.5, 1e-9);
  EXPECT_NEAR(of(Phase::Mark).motion.path_length, 0.1, 1e-9);
  EXPECT_NEAR(of(Phase::Suture).motion.path_length, 0.05, 1e-9);
  EXPECT_EQ(of(Phase::Mark).motion.submovements, 1);
  EXPECT_NEAR(*of(Phase::Mark).motion.economy, 1, 1e-9);
  EXPECT_NEAR(*of(Phase::Mark).motion.log_dimensionless_jerk, -std::log(204.8), 0.1);
  EXPECT_NEAR(*of(Phase::Suture).motion.spectral_arc_length, -1.41, 0.02);
  EXPECT_DOUBLE_EQ(of(Phase::Mark).force.max, 2);
  EXPECT_EQ(of(Phase::Mark).force.time_above, 0);
  EXPECT_NEAR(of(Phase::Suture).force.time_above, 1, 1e-9);
  EXPECT_EQ(of(Phase::Pull).time, 0);
  EXPECT_FALSE(of(Phase::Pull).motion.economy.has_value());
}

TEST_F(PhaseSkillTest, addsUpToTheWhole) {
  // phases that change in the middle of a movement, and come back
  for (int k = 1; k <= 600; ++k) {
    tip = Eigen::Vector3d(0.03 * std::sin(0.05 * k), 0.02 * std::cos(0.031 * k), 1e-4 * k);
    recorder.record(static_cast<Phase>(k / 47 % kPhaseCount), tip, 1 + std::sin(0.1 * k), kPeriod);
  }
  double time = 0, path = 0, impulse = 0;
  for (const PhaseSkill& skill : recorder.measures().phase) {
    EXPECT_GT(skill.motion.path_length, 0);
    time += skill.time;
    path += skill.motion.path_length;
    impulse += skill.force.impulse;
  }
  EXPECT_NEAR(time, 10, 1e-9);
  EXPECT_NEAR(whole().time, 10, 1e-9);
  EXPECT_NEAR(whole().motion.path_length, path, 1e-12);
  EXPECT_NEAR(whole().force.impulse, impulse, 1e-12);
}

TEST_F(PhaseSkillTest, aPhaseThatComesBackGoesOnAndForgetsTheWayBetween) {
  reach(Phase::Mark, 0.1, 1);
  reach(Phase::Suture, 0.5, 1);
  reach(Phase::Mark, 0.1, 1);
  EXPECT_NEAR(of(Phase::Mark).motion.path_length, 0.2, 1e-9);
  EXPECT_EQ(of(Phase::Mark).motion.movements, 2);
  EXPECT_NEAR(of(Phase::Mark).time, 3, 1e-9);
}

TEST_F(PhaseSkillTest, leavesOutWhatIsNotANumber) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  recorder.record(Phase::Inspect, Eigen::Vector3d(0.01, 0, 0), 1, kPeriod);
  recorder.record(Phase::Inspect, Eigen::Vector3d(nan, 0, 0), nan, kPeriod);
  recorder.record(Phase::Mark, Eigen::Vector3d(0.02, 0, 0), 1, kPeriod);
  EXPECT_NEAR(whole().motion.path_length, 0.02, 1e-12);
  EXPECT_NEAR(of(Phase::Mark).motion.path_length, 0.01, 1e-12);
  EXPECT_NEAR(whole().force.impulse, 2 * kPeriod, 1e-12);
  EXPECT_NEAR(whole().time, 3 * kPeriod, 1e-12);
}

TEST(PhaseSkill, withoutAToolHasTimesButNoMotion) {
  PhaseRecorder recorder(std::make_shared<SpectralArcLength>(64));
  for (int k = 0; k < 60; ++k) recorder.record(Phase::Inspect, Eigen::Vector3d(0.01 * k, 0, 0), 0, kPeriod);
  EXPECT_NEAR(recorder.measures().whole.time, 1, 1e-9);
  EXPECT_EQ(recorder.measures().whole.motion.path_length, 0);
  EXPECT_FALSE(recorder.measures().whole.motion.economy.has_value());
}

}  // namespace
}  // namespace vibe::skill_phases_test
