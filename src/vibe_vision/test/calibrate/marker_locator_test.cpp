#include "vibe_vision/calibrate/marker_finder.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "vibe_testing/expect_error.hpp"
#include "vibe_vision/calibrate/axis_fit.hpp"
#include "vibe_vision/synthetic/renderer.hpp"

namespace vibe::vision::marker_locator_test {
namespace {

constexpr double kRate = 10;                     // stops per second of the synthetic time
constexpr double kFirst = -20e-3, kStep = 5e-3;  // [m]

/// The standard rig with one instrument left, its axis slanted to all sides; it stands still at known slides.
SyntheticScene stoppedScene(std::size_t instrument, double angle, double perspective, bool bent) {
  SyntheticScene scene = namedScene(bent ? "light" : "static");
  SyntheticInstrument only = scene.instruments[instrument];
  only.nominal.axis.origin = {355, 280};
  only.nominal.axis.direction = {std::cos(angle), std::sin(angle)};
  only.nominal.axis.pixels_per_metre = 9400;
  only.nominal.axis.perspective = perspective;
  only.lateral = 0;
  only.motion.slide = [](double time) { return kFirst + kStep * std::round(time * kRate); };
  only.motion.rotation = [](double time) { return 0.9 * time * kRate; };
  scene.instruments = {only};
  scene.rate = kRate;
  return scene;
}

/// Images at the stops; the frames keep their pixels alive.
std::vector<Frame> imagesOf(const SyntheticScene& scene, std::uint64_t count) {
  const Renderer renderer(scene);
  std::vector<Frame> frames;
  for (std::uint64_t i = 0; i < count; ++i) frames.push_back(renderer.render(i).frame);
  return frames;
}

AxisFit calibrate(const SyntheticScene& scene, std::uint64_t count) {
  const LocatedMarkers located = locateMarkers(nominalConfig(scene), 0, imagesOf(scene, count), {8e3, 11e3});
  std::vector<AxisStop> stops;
  for (std::size_t i = 0; i < located.markers.size(); ++i) {
    EXPECT_TRUE(located.markers[i].found) << i << " " << located.markers[i].problem;
    if (!located.markers[i].found) continue;
    stops.push_back({"stop", kFirst + kStep * static_cast<double>(i), located.markers[i].pixel});
  }
  return fitAxis(stops);
}

/// Largest difference between the places of the marker according to two axes [px].
double largestDifference(const SlideAxis& a, const SlideAxis& b) {
  double largest = 0;
  for (double slide = kFirst; slide <= -kFirst; slide += 1e-3) {
    const Eigen::Vector2d one = a.origin + alongOf(a, slide) * a.direction;
    const Eigen::Vector2d other = b.origin + alongOf(b, slide) * b.direction;
    largest = std::max(largest, (one - other).norm());
  }
  return largest;
}

struct Case {
  std::size_t instrument;
  double angle, perspective;
  bool bent;
};

class LocatedStops : public testing::TestWithParam<Case> {};

TEST_P(LocatedStops, GiveTheAxis) {
  const Case& c = GetParam();
  const SyntheticScene scene = stoppedScene(c.instrument, c.angle, c.perspective, c.bent);
  const AxisFit fit = calibrate(scene, 9);
  EXPECT_LT(largestDifference(fit.axis, scene.instruments[0].nominal.axis), c.instrument == 0 ? 0.3 : 0.1);
  EXPECT_LT(fit.rms_along, 0.1);
  EXPECT_LT(fit.rms_across, c.instrument == 0 ? 0.25 : 0.05);  // bars do not show where they are across the axis
}

INSTANTIATE_TEST_SUITE_P(Axis, LocatedStops,
                         testing::Values(Case{0, 0.4, 0, false}, Case{0, -2.2, 0.3, true}, Case{1, 2.9, 0, false},
                                         Case{1, -0.6, 0.3, true}));

TEST(MarkerLocator, ASleeveSaysWherePositiveSlideIs) {
  const SyntheticScene scene = stoppedScene(0, 2.5, 0, false);
  const LocatedMarkers located = locateMarkers(nominalConfig(scene), 0, imagesOf(scene, 3), {9e3, 10e3});
  EXPECT_GT(located.direction.normalized().dot(scene.instruments[0].nominal.axis.direction), 0.99);
}

TEST(MarkerLocator, TheSizeOfTheMarkerGivesTheScale) {
  for (const std::size_t instrument : {0U, 1U}) {
    const SyntheticScene scene = stoppedScene(instrument, 0.2, 0, false);
    const LocatedMarkers located = locateMarkers(nominalConfig(scene), 0, imagesOf(scene, 6), {8e3, 11e3});
    std::vector<MotionSample> samples;
    for (const LocatedMarker& marker : located.markers)
      if (marker.found) samples.push_back({marker.pixel, marker.pixels_per_metre});
    ASSERT_GE(samples.size(), 5U);
    const MotionFit fit = fitMotion(samples, {0.002, 0.05}, located.direction);
    EXPECT_NEAR(fit.axis.pixels_per_metre, 9400, 3 * fit.scale_uncertainty * 9400) << instrument;
    EXPECT_NEAR(fit.axis.pixels_per_metre, 9400, 0.01 * 9400) << instrument;
  }
}

TEST(MarkerLocator, AMarkerThatIsNotThereIsSaid) {
  const SyntheticScene scene = stoppedScene(1, 0.2, 0, false);
  VisionConfig config = nominalConfig(scene);
  config.instruments[0].marker = defaultSleeve();  // the images show a ring
  const std::vector<Frame> images = imagesOf(scene, 3);
  EXPECT_ERROR(locateMarkers(config, 0, images, {8e3, 11e3}), "was found in 0 of 3 images");
}

TEST(MarkerLocator, ImagesOfAnotherSizeAreSaid) {
  const SyntheticScene scene = stoppedScene(1, 0.2, 0, false);
  VisionConfig config = nominalConfig(scene);
  config.camera.width = 1936;
  const std::vector<Frame> images = imagesOf(scene, 1);
  EXPECT_ERROR(locateMarkers(config, 0, images, {}), "an image has 728 x 544 px, the configuration is for 1936 x 544");
}

}  // namespace
}  // namespace vibe::vision::marker_locator_test
