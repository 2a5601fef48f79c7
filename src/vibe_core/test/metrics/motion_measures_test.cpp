#include "vibe_core/metrics/motion_measures.hpp"

#include <gtest/gtest.h>

#include <functional>
#include <limits>
#include <vector>

#include "metrics/motions.hpp"
#include "trainee/operator.hpp"
#include "vibe_core/program/error.hpp"
#include "vibe_testing/allocation_count.hpp"

namespace vibe::motion_measures_test {
namespace {

using test::publishedBell;
using test::sampleReach;

constexpr double kRate = 60;                 // [Hz]
const double kReachJerk = -std::log(204.8);  // T^3 / v_peak^2 * 720 L^2 / T^5 with v_peak = 15/8 L / T

using Path = std::function<Eigen::Vector3d(double)>;

/// Records a path at a rate [Hz].
MotionRecorder record(const Path& path, double duration, double rate = kRate) {
  MotionRecorder recorder;
  for (int i = 0; i <= std::lround(duration * rate); ++i) recorder.add(path(i / rate), 1 / rate);
  recorder.finish();
  return recorder;
}

/// A reach along a diagonal from `start`.
Eigen::Vector3d reach(double t, double start, double length, double duration) {
  return Eigen::Vector3d(1, 2, 2) / 3 * length * minimumJerk((t - start) / duration);
}

MotionMeasures ofTremblingReach(double tremor) {
  return record(
             [&](double t) {
               return Eigen::Vector3d(reach(t, 0.5, 0.1, 2) +
                                      tremor * std::sin(2 * M_PI * 9 * t) * Eigen::Vector3d::UnitX());
             },
             3)
      .measures();
}

TEST(LogDimensionlessJerk, agreesWithThePublishedProgram) {
  EXPECT_NEAR(*logDimensionlessJerk(publishedBell(), 0.01), -5.81636, 5e-6);
}

TEST(LogDimensionlessJerk, ofAReachIsAnalyticWhateverItsLengthAndDuration) {
  for (double length : {0.01, 1.0})
    for (double duration : {0.5, 1.0, 8.0})
      EXPECT_NEAR(*logDimensionlessJerk(sampleReach(length, duration, duration / 2000), duration / 2000), kReachJerk,
                  5e-3);
}

TEST(LogDimensionlessJerk, ofManyArchesOfASineIsAnalytic) {
  // v = 1 + sin(w t) from 0 to T = n cycles: T^3 / 4 * w^4 T / 2 = (2 pi n)^4 / 8
  for (int n : {1, 3}) {
    std::vector<double> speed;
    for (int i = 0; i < 4000; ++i) speed.push_back(1 + std::sin(2 * M_PI * n * i / 4000.0));
    EXPECT_NEAR(*logDimensionlessJerk(speed, 1e-3), -std::log(std::pow(2 * M_PI * n, 4) / 8), 2e-3);
  }
}

TEST(LogDimensionlessJerk, hasNoValueWithoutMotionOrJerk) {
  EXPECT_FALSE(logDimensionlessJerk({}, 0.01));
  EXPECT_FALSE(logDimensionlessJerk({1, 2}, 0.01));
  EXPECT_FALSE(logDimensionlessJerk(std::vector<double>(100, 0.0), 0.01));
  EXPECT_FALSE(logDimensionlessJerk(std::vector<double>(100, 0.3), 0.01));
  EXPECT_FALSE(logDimensionlessJerk({0, 1, 0}, 0));
  EXPECT_FALSE(logDimensionlessJerk({0, std::numeric_limits<double>::quiet_NaN(), 0}, 0.01));
}

TEST(MotionRecorder, measuresAReach) {
  const MotionMeasures m = record([](double t) { return reach(t, 1, 0.1, 2); }, 4).measures();
  EXPECT_NEAR(m.time, 4, 1e-9);
  EXPECT_NEAR(m.path_length, 0.1, 1e-12);
  EXPECT_NEAR(*m.mean_speed, 0.025, 1e-9);
  EXPECT_NEAR(m.max_speed, 15.0 / 8 * 0.05, 1e-4);
  EXPECT_NEAR(m.movement_time, 2, 0.1);
  EXPECT_NEAR(m.movement_time + m.idle_time, m.time, 1e-9);
  EXPECT_EQ(m.movements, 1);
  EXPECT_EQ(m.submovements, 1);
  EXPECT_NEAR(*m.economy, 1, 1e-9);
  EXPECT_NEAR(*m.log_dimensionless_jerk, kReachJerk, 0.15);
  EXPECT_NEAR(*m.spectral_arc_length, *spectralArcLength(sampleReach(0.1, 2, 1e-3), 1e-3), 0.02);
}

TEST(MotionRecorder, smoothnessDoesNotDependOnSizeDurationOrStep) {
  const MotionMeasures one = record([](double t) { return reach(t, 1, 0.1, 2); }, 4).measures();
  std::vector<MotionMeasures> others = {record([](double t) { return reach(t, 1, 0.2, 2); }, 4).measures(),
                                        record([](double t) { return reach(t, 1, 0.1, 1); }, 4).measures()};
  for (double rate : {50.0, 100.0, 144.0, 1000.0})
    others.push_back(record([](double t) { return reach(t, 1, 0.1, 2); }, 4, rate).measures());
  for (const MotionMeasures& m : others) {
    EXPECT_NEAR(*m.log_dimensionless_jerk, *one.log_dimensionless_jerk, 0.15);
    EXPECT_NEAR(*m.spectral_arc_length, *one.spectral_arc_length, 0.02);
    EXPECT_EQ(m.movements, 1);
  }
}

TEST(MotionRecorder, ofASine) {
  // 20 mm to and fro, twice a second, for 5 s: ten cycles of 80 mm, the speed has two peaks a cycle
  const MotionMeasures m =
      record([](double t) { return Eigen::Vector3d(0.02 * std::sin(4 * M_PI * t), 0, 0); }, 5, 1000).measures();
  EXPECT_NEAR(m.path_length, 0.8, 1e-4);
  EXPECT_NEAR(*m.mean_speed, 0.16, 1e-4);
  EXPECT_EQ(m.movements, 1) << "a turn is no rest";
  EXPECT_EQ(m.submovements, 21) << "half an arch at each end";
  EXPECT_NEAR(*m.economy, 0, 1e-3);
  EXPECT_NEAR(m.idle_time, 0, 0.02);
}

TEST(MotionRecorder, ofACircle) {
  // a quarter at an even speed: chord over arc is 2 sqrt(2) / pi, and an even speed has no jerk
  const auto m =
      record([](double t) { return Eigen::Vector3d(0.1 * std::cos(M_PI / 2 * t), 0.1 * std::sin(M_PI / 2 * t), 0); }, 1)
          .measures();
  EXPECT_NEAR(m.path_length, 0.05 * M_PI, 1e-4);
  EXPECT_NEAR(*m.economy, 2 * std::sqrt(2) / M_PI, 1e-4);
  EXPECT_NEAR(m.max_speed, 0.05 * M_PI, 1e-4);
  EXPECT_EQ(m.submovements, 1);
  EXPECT_FALSE(m.log_dimensionless_jerk);
  EXPECT_TRUE(m.spectral_arc_length);
}

TEST(MotionRecorder, aStandstillHasNoValues) {
  for (const MotionMeasures& m :
       {record([](double) { return Eigen::Vector3d(0.1, 0.2, 0.3); }, 5).measures(), MotionRecorder().measures()}) {
    EXPECT_EQ(m.path_length, 0);
    EXPECT_EQ(m.movements, 0);
    EXPECT_EQ(m.submovements, 0);
    EXPECT_EQ(m.movement_time, 0);
    EXPECT_EQ(m.idle_time, m.time);
    EXPECT_FALSE(m.economy);
    EXPECT_FALSE(m.log_dimensionless_jerk);
    EXPECT_FALSE(m.spectral_arc_length);
  }
  EXPECT_FALSE(MotionRecorder().measures().mean_speed);
}

TEST(MotionRecorder, tremorLowersBothSmoothnesses) {
  MotionMeasures last = ofTremblingReach(0);
  for (double tremor : {0.1e-3, 0.2e-3, 0.4e-3, 0.8e-3}) {
    const MotionMeasures m = ofTremblingReach(tremor);
    EXPECT_LT(*m.log_dimensionless_jerk, *last.log_dimensionless_jerk) << tremor;
    EXPECT_LE(*m.spectral_arc_length, *last.spectral_arc_length + 0.01) << tremor;
    EXPECT_GT(m.path_length, last.path_length);
    last = m;
  }
  EXPECT_LT(*last.spectral_arc_length, *ofTremblingReach(0).spectral_arc_length - 0.3);
}

TEST(MotionRecorder, aTremblingHandAtRestIsAtRest) {
  const auto m = record([](double t) { return Eigen::Vector3d(2e-3 * std::sin(2 * M_PI * 9 * t), 0, 0); }, 5);
  EXPECT_EQ(m.measures().movements, 0);
  EXPECT_GT(m.measures().max_speed, 0.09) << "although it is fast";
  const auto slow = record([](double t) { return Eigen::Vector3d(2e-3 * std::sin(2 * M_PI * 2 * t), 0, 0); }, 5);
  EXPECT_EQ(slow.measures().movements, 1) << "to and fro on purpose is no tremor";
}

TEST(MotionRecorder, twoSubmovementsAreLessSmoothThanOneAndTwoMovementsAreNot) {
  const auto two = [](double gap) {
    return record([gap](double t) { return Eigen::Vector3d(reach(t, 1, 0.1, 1) + reach(t, 2 + gap, 0.1, 1)); }, 6)
        .measures();
  };
  const MotionMeasures one = record([](double t) { return reach(t, 1, 0.1, 1); }, 6).measures();
  const MotionMeasures together = two(0), apart = two(1);
  EXPECT_EQ(together.movements, 1);
  EXPECT_EQ(together.submovements, 2);
  EXPECT_LT(*together.log_dimensionless_jerk, *one.log_dimensionless_jerk - 1);
  EXPECT_LT(*together.spectral_arc_length, *one.spectral_arc_length - 0.3);
  EXPECT_EQ(apart.movements, 2);
  EXPECT_EQ(apart.submovements, 2);
  EXPECT_NEAR(*apart.log_dimensionless_jerk, *one.log_dimensionless_jerk, 0.05);
  EXPECT_NEAR(*apart.spectral_arc_length, *one.spectral_arc_length, 0.01);
}

TEST(MotionRecorder, weighsMovementsByTheirDuration) {
  const auto smooth = [](double t) { return reach(t, 1, 0.1, 3); };
  const auto rough = [](double t) { return Eigen::Vector3d(reach(t, 6, 0.05, 0.5) + reach(t, 6.5, 0.05, 0.5)); };
  const MotionMeasures a = record(smooth, 9).measures(), b = record(rough, 9).measures();
  const MotionMeasures both = record([&](double t) { return Eigen::Vector3d(smooth(t) + rough(t)); }, 9).measures();
  const double whole = a.movement_time + b.movement_time;
  EXPECT_NEAR(both.movement_time, whole, 1e-9);
  EXPECT_NEAR(*both.log_dimensionless_jerk,
              (a.movement_time * *a.log_dimensionless_jerk + b.movement_time * *b.log_dimensionless_jerk) / whole,
              1e-9);
}

TEST(MotionRecorder, goesOnAfterFinishWithoutTheWayBetween) {
  MotionRecorder recorder;
  for (int phase = 0; phase < 2; ++phase) {
    for (int i = 0; i <= 120; ++i)
      recorder.add(Eigen::Vector3d(phase, 0, 0) + reach(i / kRate, 0.5, 0.1, 1), 1 / kRate);
    recorder.finish();
  }
  EXPECT_NEAR(recorder.measures().path_length, 0.2, 1e-12);
  EXPECT_NEAR(recorder.measures().time, 4, 1e-9);
  EXPECT_EQ(recorder.measures().movements, 2);
}

TEST(MotionRecorder, livesWithUnevenSteps) {
  MotionRecorder recorder;
  double t = 0;
  for (int i = 0; t < 4; ++i) {
    const double dt = 0.002 + 0.003 * (i % 5);
    t += dt;
    recorder.add(reach(t, 1, 0.1, 2), dt);
  }
  recorder.finish();
  const MotionMeasures m = recorder.measures();
  EXPECT_NEAR(m.path_length, 0.1, 1e-12);
  EXPECT_NEAR(m.max_speed, 15.0 / 8 * 0.05, 1e-3);
  EXPECT_NEAR(*m.spectral_arc_length, *spectralArcLength(sampleReach(0.1, 2, 1e-3), 1e-3), 0.02);
  EXPECT_EQ(m.submovements, 1);
}

TEST(MotionRecorder, refusesWhatIsNoMotion) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  MotionRecorder recorder;
  recorder.add(Eigen::Vector3d::Zero(), 0.01);
  recorder.add(Eigen::Vector3d(1, 0, 0), 0.01);
  EXPECT_THROW(recorder.add(Eigen::Vector3d(0, nan, 0), 0.01), Error);
  for (double bad : {nan, 0.0, -0.1, std::numeric_limits<double>::infinity()})
    EXPECT_THROW(recorder.add(Eigen::Vector3d::Zero(), bad), Error);
  EXPECT_EQ(recorder.measures().path_length, 1);
  EXPECT_EQ(recorder.measures().time, 0.01);
  MotionSettings settings;
  settings.rest_reach = nan;
  EXPECT_THROW(MotionRecorder{settings}, Error);
}

TEST(MotionRecorder, asksForNoMemoryInASessionOfTenMinutes) {
  if (!VIBE_COUNTS_ALLOCATIONS) GTEST_SKIP() << "nothing counts allocations here";
  MotionRecorder recorder;
  const long before = test::allocations;
  // a minute without a rest, then pauses: pieces, long and short movements
  for (int i = 0; i < 600 * 60; ++i) {
    const double t = i / kRate, s = t < 60 ? t : std::floor(t) + minimumJerk(2 * (t - std::floor(t)));
    recorder.add(Eigen::Vector3d(0.1 * std::sin(s), 0.1 * std::cos(2 * s), 0), 1 / kRate);
    if (i % 60 == 0) recorder.measures();
  }
  recorder.finish();
  EXPECT_EQ(test::allocations, before);
  EXPECT_GT(recorder.measures().movements, 500);
  EXPECT_LT(*recorder.measures().spectral_arc_length, -1);
}

}  // namespace
}  // namespace vibe::motion_measures_test
