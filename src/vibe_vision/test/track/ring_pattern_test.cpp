// The picture of a ring against a plain integral over its area, and its derivatives against differences.
#include "track/ring_pattern.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace vibe::vision::ring_pattern_test {
namespace {

constexpr double kScale = 5000;  // [px/m]: a ring of 20 px

/// Mean reflectance at a pixel: Gaussian blur, area of the pixel and motion, by brute force.
double reference(const MarkerPose& pose, double motion, double along, double lateral) {
  const RingDesign ring;
  const double inner = ring.inner_diameter / 2 * kScale, outer = ring.outer_diameter / 2 * kScale;
  const double blur = std::sqrt(pose.blur * pose.blur + 1.0 / 12);
  const double size_v = std::exp(pose.log_scale), size_u = size_v * std::exp(pose.log_aspect);
  constexpr int kSteps = 60, kMotions = 24;
  double sum = 0, weights = 0;
  for (int i = -kSteps; i <= kSteps; ++i)
    for (int j = -kSteps; j <= kSteps; ++j) {
      const double a = 4.5 * i / kSteps, b = 4.5 * j / kSteps, weight = std::exp(-(a * a + b * b) / 2);
      for (int k = 0; k < kMotions; ++k) {
        const double x = along + a * blur - pose.along + motion * ((k + 0.5) / kMotions - 0.5);
        const double y = lateral + b * blur - pose.lateral;
        const double p = std::cos(pose.tilt) * x + std::sin(pose.tilt) * y;
        const double q = std::cos(pose.tilt) * y - std::sin(pose.tilt) * x;
        const double r = std::hypot(p * (1 - pose.keystone * p) / size_u, q * (1 - pose.keystone * p) / size_v);
        sum += r < inner || r > outer ? weight : 0;
        weights += weight;
      }
    }
  return sum / weights;
}

class RingPatternTest : public ::testing::Test {
 protected:
  void SetUp() override {
    pixels_.allocate(512);
    values_.allocate(512, pattern_.observes());
    for (int i = -11; i <= 11; i += 2)
      for (int j = -11; j <= 11; j += 2) {
        pixels_.along[pixels_.count] = static_cast<float>(200 + i);
        pixels_.lateral[pixels_.count] = static_cast<float>(j);
        pixels_.value[pixels_.count] = 0;
        pixels_.weight[pixels_.count++] = 1;
      }
    pixels_.pad();
    pose_.along = 200.3, pose_.lateral = -0.4, pose_.blur = 0.6;
  }

  PixelBlock pixels_;
  PatternValues values_;
  RingPattern pattern_{RingDesign(), kScale};
  MarkerPose pose_;
};

void slant(MarkerPose& pose) {
  pose.log_scale = 0.06, pose.log_aspect = -0.05, pose.tilt = 0.25, pose.keystone = 5e-4;
}

TEST_F(RingPatternTest, ThePictureIsTheIntegralOverTheRing) {
  for (double motion : {0.0, 2.3, 6.0})
    for (bool slanted : {false, true}) {
      if (slanted) slant(pose_);
      pattern_.prepare(pose_, motion);
      pattern_.evaluate(pose_, pixels_, values_);
      for (std::size_t i = 0; i < pixels_.count; i += 5)
        EXPECT_NEAR(values_.value[i], reference(pose_, motion, pixels_.along[i], pixels_.lateral[i]), 0.012)
            << "motion " << motion << " slanted " << slanted << " pixel " << i;
    }
}

TEST_F(RingPatternTest, MotionChangesThePicture) {
  pattern_.prepare(pose_, 0);
  pattern_.evaluate(pose_, pixels_, values_);
  const std::vector<float> at_rest = values_.value;
  pattern_.prepare(pose_, 6);
  pattern_.evaluate(pose_, pixels_, values_);
  double most = 0;
  for (std::size_t i = 0; i < pixels_.count; ++i)
    most = std::max<double>(most, std::abs(at_rest[i] - values_.value[i]));
  EXPECT_GT(most, 0.2);
}

TEST_F(RingPatternTest, DerivativesAreThoseOfThePicture) {
  slant(pose_);
  const double steps[kPoseParameters] = {5e-3, 5e-3, 0, 5e-4, 2e-3, 5e-4, 5e-3, 2e-5, 0};
  for (double motion : {0.0, 4.0})
    for (int k = 0; k < kPoseParameters; ++k) {
      if (!pattern_.observes()[k]) continue;
      double* parameter[] = {&pose_.along,      &pose_.lateral, &pose_.rotation, &pose_.log_scale, &pose_.tilt,
                             &pose_.log_aspect, &pose_.blur,    &pose_.keystone, &pose_.slant};
      const double start = *parameter[k];
      std::vector<float> side[2];
      pattern_.prepare(pose_, motion);
      for (int s : {0, 1}) {
        *parameter[k] = start + (s == 0 ? -1 : 1) * steps[k];
        pattern_.evaluate(pose_, pixels_, values_);
        side[s] = values_.value;
      }
      *parameter[k] = start;
      pattern_.evaluate(pose_, pixels_, values_);
      double error = 0, size = 0;
      for (std::size_t i = 0; i < pixels_.count; ++i) {
        const double numeric = (side[1][i] - side[0][i]) / (2 * steps[k]);
        error += std::pow(numeric - values_.derivative[k][i], 2);
        size += numeric * numeric;
      }
      EXPECT_LT(std::sqrt(error / size), 0.04) << "parameter " << k << " motion " << motion;
    }
}

TEST_F(RingPatternTest, SelectionKeepsWhatTells) {
  pattern_.prepare(pose_, 0);
  pattern_.evaluate(pose_, pixels_, values_);
  double all = 0;
  for (std::size_t i = 0; i < pixels_.count; ++i) all += std::pow(values_.derivative[kAlong][i], 2);
  const std::size_t before = pixels_.count;
  pattern_.select(pose_, 0, pixels_);
  pattern_.evaluate(pose_, pixels_, values_);
  double kept = 0;
  for (std::size_t i = 0; i < pixels_.count; ++i) kept += std::pow(values_.derivative[kAlong][i], 2);
  EXPECT_LT(pixels_.count, before);
  EXPECT_GT(kept, 0.999 * all);
}

}  // namespace
}  // namespace vibe::vision::ring_pattern_test
