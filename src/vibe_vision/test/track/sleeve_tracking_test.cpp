#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "vibe_vision/synthetic/renderer.hpp"
#include "vibe_vision/track/tracker.hpp"

namespace vibe::vision::sleeve_tracking_test {
namespace {

constexpr int kSettle = 25;  // frames until slant and lateral place are known

struct Result {
  int lost = 0;                 ///< after kSettle
  double slide = 0;             ///< root mean square error [px]
  double rotation = 0;          ///< [rad], turns included
  double largest_slide = 0;     ///< of all reports [px]
  double largest_rotation = 0;  ///< the same [rad]
  double most_deviations = 0;   ///< the same, in standard deviations that were stated
  double nees = 0;              ///< mean of the squared error of all slides over the variance that was stated
  int reports = 0;
};

Result follow(SyntheticScene scene, int frames) {
  scene.instruments.resize(1);  // the helix
  const Renderer renderer(scene);
  Tracker tracker(nominalConfig(scene));
  Result result;
  double turns = NAN;
  int count = 0;
  for (int k = 0; k < frames; ++k) {
    const RenderedFrame rendered = renderer.render(static_cast<std::uint64_t>(k));
    const Measurement& m = tracker.track(rendered.frame)[0];
    const SyntheticTruth& truth = rendered.truth[0];
    if (!m.tracked()) {
      result.lost += k >= kSettle && truth.visible > 0.99 ? 1 : 0;
      continue;
    }
    const double error = (m.slide - truth.slide) * 1e4;
    result.largest_slide = std::max(result.largest_slide, std::abs(error));
    result.nees += std::pow(error * 1e-4, 2) / m.covariance(0, 0);
    ++result.reports;
    if (std::isnan(turns)) turns = std::round((m.rotation - truth.rotation) / (2 * M_PI));
    const double turned = m.rotation - truth.rotation - 2 * M_PI * turns;
    result.largest_rotation = std::max(result.largest_rotation, std::abs(turned));
    result.most_deviations = std::max(result.most_deviations, std::abs(turned) / std::sqrt(m.covariance(1, 1)));
    if (k < kSettle) continue;
    result.slide += error * error;
    result.rotation += turned * turned;
    ++count;
  }
  result.nees /= result.reports;
  result.slide = std::sqrt(result.slide / count);
  result.rotation = std::sqrt(result.rotation / count);
  return result;
}

void expectGood(const Result& result, double slide, double degrees) {
  EXPECT_EQ(result.lost, 0);
  EXPECT_LE(result.slide, slide);
  EXPECT_LE(result.rotation, degrees * M_PI / 180);
  EXPECT_LT(result.largest_slide, 5);
}

TEST(SleeveTracking, SlidesAtHalfAMetrePerSecond) {
  expectGood(follow(namedScene("moving"), 80), 0.01, 0.3);
}

TEST(SleeveTracking, RestsNearTheCramerRaoBound) {
  expectGood(follow(namedScene("static"), 120), 1.5 * 0.0017, 0.2);  // its bound, as cramerRaoBound() says [px]
}

TEST(SleeveTracking, CountsTurnsWhileItSlides) {
  SyntheticScene scene = namedScene("moving");
  scene.instruments[0].motion.rotation = [](double time) { return 25 * time; };
  expectGood(follow(scene, 110), 0.01, 0.3);  // 3 turns
}

TEST(SleeveTracking, TurnsWhileTheSlideStandsStill) {
  SyntheticScene scene = namedScene("static");
  scene.instruments[0].motion.rotation = [](double time) { return -25 * time; };
  expectGood(follow(scene, 110), 0.01, 0.3);
}

TEST(SleeveTracking, KnowsThatALongExposureShowsAnAcceleratedMotion) {
  const Result result = follow(namedScene("long_exposure"), 90);
  expectGood(result, 0.04, 0.6);
  EXPECT_LT(result.nees, 1.6);
}

/// One frame alone must tell 20 px of motion, on which the rotation and the place across the axis depend. Enough frames
/// that one at the edge of being found decides nothing.
TEST(SleeveTracking, TellsALongMotionInItsFirstFrame) {
  SyntheticScene scene = namedScene("long_exposure");
  scene.instruments.resize(1);
  const Renderer renderer(scene);
  int found = 0;
  double square = 0, nees = 0;
  for (int k = 0; k < 180; k += 3) {
    Tracker tracker(nominalConfig(scene));  // knows nothing
    const RenderedFrame rendered = renderer.render(static_cast<std::uint64_t>(k));
    const Measurement& m = tracker.track(rendered.frame)[0];
    if (!m.tracked()) continue;
    const double slide = m.slide - rendered.truth[0].slide;
    const double rotation = std::remainder(m.rotation - rendered.truth[0].rotation, 2 * M_PI);
    EXPECT_LT(std::abs(slide), 4 * std::sqrt(m.covariance(0, 0))) << k;
    EXPECT_LT(std::abs(rotation), std::max(0.09, 4 * std::sqrt(m.covariance(1, 1)))) << k;
    square += slide * slide;
    nees += rotation * rotation / m.covariance(1, 1);
    ++found;
  }
  EXPECT_GE(found, 48);
  EXPECT_LT(std::sqrt(square / found), 2e-5);  // a fifth of a pixel
  EXPECT_LT(nees / found, 2);
}

TEST(SleeveTracking, FollowsADefocusedPicture) {
  expectGood(follow(namedScene("defocus"), 60), 0.03, 0.6);
}

TEST(SleeveTracking, FollowsATiltedRod) {
  expectGood(follow(namedScene("tilt"), 100), 0.015, 0.3);
}

TEST(SleeveTracking, ReportsNoOtherPlaceWhenItIsPartlyCovered) {
  const Result result = follow(namedScene("occluder"), 110);
  EXPECT_EQ(result.lost, 0);
  EXPECT_LT(result.largest_slide, 0.3);
  EXPECT_LT(result.largest_rotation, 0.1);
  EXPECT_LT(result.nees, 1.5);
}

TEST(SleeveTracking, FindsItBackAfterItWasCoveredInABadPicture) {
  const Result result = follow(namedScene("all"), 110);
  EXPECT_EQ(result.lost, 0);
  EXPECT_LT(result.largest_slide, 1);
  EXPECT_LT(result.most_deviations, 6);
  EXPECT_LT(result.nees, 1.5);
}

}  // namespace
}  // namespace vibe::vision::sleeve_tracking_test
