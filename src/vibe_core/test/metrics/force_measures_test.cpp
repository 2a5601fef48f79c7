#include "vibe_core/metrics/skill_phases.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "vibe_core/program/error.hpp"

namespace vibe::force_measures_test {
namespace {

constexpr double kDt = 1e-3;

TEST(ForceMeasures, ofNothingAreNone) {
  const ForceMeasures m = ForceRecorder().measures();
  EXPECT_EQ(m.max, 0);
  EXPECT_EQ(m.impulse, 0);
  EXPECT_FALSE(m.mean);
  EXPECT_FALSE(m.share_above);
}

TEST(ForceMeasures, ofAHalfSine) {
  // 8 N sin(pi t / 2 s) for 2 s, then 2 s without load: impulse 8 N * 2 s * 2 / pi; above 5 N for (1 - 2/pi asin(5/8))
  // 2 s
  ForceRecorder recorder;
  for (int i = 0; i < 4000; ++i) {
    const double t = (i + 0.5) * kDt;
    recorder.add(t < 2 ? 8 * std::sin(M_PI * t / 2) : 0.0, kDt);
  }
  const ForceMeasures m = recorder.measures();
  const double above = 2 * (1 - 2 / M_PI * std::asin(5.0 / 8));
  EXPECT_NEAR(m.time, 4, 1e-9);
  EXPECT_NEAR(m.loaded_time, 2, 1e-9);
  EXPECT_NEAR(m.max, 8, 1e-5);
  EXPECT_NEAR(m.impulse, 32 / M_PI, 1e-4);
  EXPECT_NEAR(*m.mean, 16 / M_PI, 1e-4);
  EXPECT_NEAR(m.time_above, above, 2 * kDt);
  EXPECT_NEAR(*m.share_above, above / 4, kDt);
}

TEST(ForceMeasures, doNotDependOnDirectionOrRate) {
  ForceRecorder still, turning, slow;
  for (int i = 0; i < 1000; ++i) {
    still.add(3.0, kDt);
    turning.add(3 * Eigen::Vector3d(std::cos(i), std::sin(i), 0), kDt);
    if (i % 10 == 0) slow.add(3.0, 10 * kDt);
  }
  for (const auto* other : {&turning, &slow}) {
    EXPECT_NEAR(other->measures().impulse, still.measures().impulse, 1e-12);
    EXPECT_NEAR(*other->measures().mean, 3, 1e-12);
  }
  EXPECT_EQ(still.measures().time_above, 0);
}

TEST(ForceMeasures, takeTheThresholdFromTheSettings) {
  ForceSettings settings;
  settings.threshold = 2;
  ForceRecorder recorder(settings);
  recorder.add(2.0, kDt);
  EXPECT_EQ(recorder.measures().time_above, 0) << "at the threshold is not above it";
  recorder.add(2.1, kDt);
  EXPECT_EQ(recorder.measures().time_above, kDt);
}

TEST(ForceMeasures, refuseWhatIsNoForce) {
  const double nan = std::numeric_limits<double>::quiet_NaN(), inf = std::numeric_limits<double>::infinity();
  ForceRecorder recorder;
  recorder.add(1.0, kDt);
  for (double bad : {nan, inf, -1.0}) EXPECT_THROW(recorder.add(bad, kDt), Error);
  for (double bad : {nan, inf, 0.0, -1.0}) EXPECT_THROW(recorder.add(1.0, bad), Error);
  EXPECT_THROW(recorder.add(Eigen::Vector3d(0, nan, 0), kDt), Error);
  EXPECT_EQ(recorder.measures().impulse, kDt);
  EXPECT_EQ(recorder.measures().time, kDt);
  EXPECT_THROW(ForceRecorder({-1, 0}), Error);
  EXPECT_THROW(ForceRecorder({nan, 0}), Error);
}

}  // namespace
}  // namespace vibe::force_measures_test
