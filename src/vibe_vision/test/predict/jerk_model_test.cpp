#include "vibe_vision/predict/predictor.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace vibe::vision::jerk_model_test {
namespace {

constexpr double kStep = 1 / 147.0;  // [s]

TEST(JerkModel, ResponseIsTheClosedFormOnBothSidesOfTheChangeOfMethod) {
  const double t = 0.02;
  for (const double x : {0.5, 0.999999, 1.000001, 3.0, 20.0}) {
    const double dt = x * t;
    const Eigen::Vector4d g = jerkResponse(dt, t);
    EXPECT_NEAR(g(0), t * t * t * (1 - x + x * x / 2 - std::exp(-x)), 1e-13 * t * t * t);
    EXPECT_NEAR(g(1), t * t * (x - 1 + std::exp(-x)), 1e-13 * t * t);
    EXPECT_NEAR(g(2), t * (1 - std::exp(-x)), 1e-13 * t);
    EXPECT_NEAR(g(3), std::exp(-x), 1e-14);
  }
}

TEST(JerkModel, ResponseForShortTimesIsThatOfConstantJerk) {
  const double dt = 1e-6;  // 1e-5 of the correlation time: the closed form has no correct digit left here
  const Eigen::Vector4d g = jerkResponse(dt, 0.1);
  EXPECT_NEAR(g(0) / (dt * dt * dt / 6), 1, 1e-5);
  EXPECT_NEAR(g(1) / (dt * dt / 2), 1, 1e-5);
  EXPECT_NEAR(g(2) / dt, 1, 1e-5);
}

TEST(JerkModel, TwoIntervalsAreOne) {
  const JerkModel jerk{40, 0.02};
  for (const double a : {0.003, 0.05})
    for (const double b : {0.007, 0.2}) {
      const Eigen::Matrix4d f = motionTransition(b, jerk.time);
      const Eigen::Matrix4d both = f * jerkNoise(a, jerk) * f.transpose() + jerkNoise(b, jerk);
      EXPECT_TRUE((f * motionTransition(a, jerk.time)).isApprox(motionTransition(a + b, jerk.time), 1e-12));
      EXPECT_TRUE(both.isApprox(jerkNoise(a + b, jerk), 1e-9)) << a << " " << b;
      for (int i = 0; i < 4; ++i) EXPECT_NEAR(both(i, i) / jerkNoise(a + b, jerk)(i, i), 1, 1e-9) << i;
    }
}

TEST(JerkModel, NoiseOfShortCorrelationIsThatOfWhiteJerk) {
  const JerkModel jerk{1000, 1e-5};
  const double q = 2 * jerk.deviation * jerk.deviation * jerk.time, t = kStep;
  Eigen::Matrix3d expected;
  expected << std::pow(t, 5) / 20, std::pow(t, 4) / 8, std::pow(t, 3) / 6,  //
      std::pow(t, 4) / 8, std::pow(t, 3) / 3, std::pow(t, 2) / 2,           //
      std::pow(t, 3) / 6, std::pow(t, 2) / 2, t;
  const Eigen::Matrix3d found = jerkNoise(t, jerk).topLeftCorner<3, 3>() / q;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) EXPECT_NEAR(found(i, j) / expected(i, j), 1, 0.01) << i << j;
}

TEST(JerkModel, NoiseOfLongCorrelationIsThatOfWhiteSnap) {
  const JerkModel jerk{1000, 1e6};
  const double s = 2 * jerk.deviation * jerk.deviation / jerk.time, t = kStep;
  const Eigen::Matrix4d found = jerkNoise(t, jerk);
  EXPECT_NEAR(found(0, 0) / (s * std::pow(t, 7) / 252), 1, 1e-6);
  EXPECT_NEAR(found(0, 3) / (s * std::pow(t, 4) / 24), 1, 1e-6);
  EXPECT_NEAR(found(1, 1) / (s * std::pow(t, 5) / 20), 1, 1e-6);
  EXPECT_NEAR(found(3, 3) / (s * t), 1, 1e-6);
}

TEST(JerkModel, VarianceOfTheJerkStaysThatOfTheProcess) {
  const JerkModel jerk{40, 0.02};
  for (const double dt : {0.001, 0.02, 0.5}) {
    const double decay = std::exp(-dt / jerk.time);
    EXPECT_NEAR(decay * decay * 1600 + jerkNoise(dt, jerk)(3, 3), 1600, 1e-6);
  }
}

}  // namespace
}  // namespace vibe::vision::jerk_model_test
