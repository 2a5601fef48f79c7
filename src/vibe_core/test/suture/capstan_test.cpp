#include "suture/capstan.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "vibe_core/program/error.hpp"

namespace vibe::capstan_test {
namespace {

using Eigen::Vector3d;
constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kPi = 3.14159265358979323846;

TEST(Capstan, AnglesOfTurn) {
  const Vector3d a(0, 0, 0), b(1, 0, 0);
  EXPECT_NEAR(turningAngle(a, b, {2, 0, 0}), 0, 1e-15);
  EXPECT_NEAR(turningAngle(a, b, {1, 3, 0}), kPi / 2, 1e-15);
  EXPECT_NEAR(turningAngle(a, b, {0.5, 0, 0}), kPi, 1e-15);
  EXPECT_NEAR(turningAngle(a, b, {2, 1e-9, 0}), 1e-9, 1e-17);
  EXPECT_EQ(turningAngle(a, a, b), 0);
}

TEST(Capstan, FactorIsExponential) {
  EXPECT_NEAR(capstanFactor(0.15, kPi / 2), std::exp(0.15 * kPi / 2), 1e-15);
  EXPECT_EQ(capstanFactor(0, kPi), 1);
  EXPECT_EQ(capstanFactor(kInfinity, 0), kInfinity);
  EXPECT_THROW(capstanFactor(-0.1, 1), Error);
  EXPECT_THROW(capstanFactor(0.1, std::nan("")), Error);
}

}  // namespace
}  // namespace vibe::capstan_test
