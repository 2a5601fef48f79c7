#include "vibe_firmware/core/axis_control.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace vibe_firmware::velocity_filter_test {
namespace {

TEST(VelocityFilter, StepResponseIsTheGeometricOne) {
  for (const float pole : {0.0F, 0.5F, 0.9F, 0.99F}) {
    float velocity = 0;
    for (int k = 1; k <= 200; ++k) {
      velocity = filteredVelocity(pole, velocity, 3);
      ASSERT_NEAR(velocity, 3 * (1 - std::pow(static_cast<double>(pole), k)), 1e-5)
          << "pole " << pole << ", tick " << k;
    }
  }
}

TEST(VelocityFilter, AlternatingMotionIsReducedByTheFactorOfThePassivityCondition) {
  const float pole = 0.9F;
  float velocity = 0;
  for (int k = 0; k < 400; ++k) velocity = filteredVelocity(pole, velocity, k % 2 == 0 ? 1.0F : -1.0F);
  EXPECT_NEAR(std::fabs(velocity), (1 - 0.9) / (1 + 0.9), 1e-6);
}

}  // namespace
}  // namespace vibe_firmware::velocity_filter_test
