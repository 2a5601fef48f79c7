#include "vibe_graphics/geometry/endoscope_optics.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace vibe::graphics::auto_exposure_test {
namespace {

/// Level of a picture of one brightness, as media/endoscope.frag shows it.
double levelOf(double radiance, double gain) {
  return std::pow(1 - std::exp(-gain * radiance), 0.6);
}

TEST(AutoExposureTest, FirstPictureIsTakenAgainUntilItsLevelIsRight) {
  for (const double radiance : {0.02, 0.3, 1.0, 8.0}) {
    AutoExposure exposure;
    int pictures = 0;
    double level = 0;
    do {
      level = levelOf(radiance, exposure.gain());
      exposure.see(level, 1);
      ++pictures;
    } while (exposure.isLost());
    EXPECT_LE(pictures, 4);
    EXPECT_NEAR(levelOf(radiance, exposure.gain()), AutoExposure::kTarget, 0.05) << radiance;
  }
  EXPECT_GT(std::abs(levelOf(8, AutoExposure::kFixedGain) - AutoExposure::kTarget), 0.3);  // control: without it
}

TEST(AutoExposureTest, FollowsAtALimitedRateAndSettlesOnTheTarget) {
  AutoExposure exposure;
  for (int k = 0; k < 4; ++k) exposure.see(levelOf(1, exposure.gain()), 0);
  double before = exposure.gain();
  const double period = 1 / 30.;
  for (int frame = 1; frame < 90; ++frame) {
    exposure.see(levelOf(0.05, exposure.gain()), frame * period);  // much darker from now on
    EXPECT_LE(std::log2(exposure.gain() / before), AutoExposure::kRate * period + 1e-9);
    EXPECT_FALSE(exposure.isLost());
    before = exposure.gain();
    if (frame == 3) {
      EXPECT_LT(levelOf(0.05, before), 0.8 * AutoExposure::kTarget);  // control: not at once
    }
  }
  EXPECT_NEAR(levelOf(0.05, exposure.gain()), AutoExposure::kTarget, 0.01);
}

TEST(AutoExposureTest, IsAFunctionOfWhatItHasSeenAndBeginsAnewAfterAGap) {
  AutoExposure a, b;
  for (int frame = 0; frame < 20; ++frame) {
    a.see(0.4 + 0.005 * frame, 0.04 * frame), b.see(0.4 + 0.005 * frame, 0.04 * frame);
    EXPECT_EQ(a.gain(), b.gain());
  }
  const double before = a.gain();
  a.see(0.05, 10);  // a gap: as far as needed
  EXPECT_GT(a.gain(), 4 * before);
  EXPECT_TRUE(a.isLost());
  b.see(0.05, 0.8);  // control: no gap
  EXPECT_LT(b.gain(), 1.5 * before);
}

TEST(AutoExposureTest, BlackAndWhitePicturesEndAtTheLimits) {
  AutoExposure dark, bright;
  for (int frame = 0; frame < 600; ++frame) dark.see(0, frame / 30.), bright.see(1, frame / 30.);
  EXPECT_DOUBLE_EQ(dark.gain(), AutoExposure::kMaxGain);
  EXPECT_DOUBLE_EQ(bright.gain(), AutoExposure::kMinGain);
}

}  // namespace
}  // namespace vibe::graphics::auto_exposure_test
