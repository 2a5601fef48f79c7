// Optics, exposure, light, noise and what else happens to a picture.
#include "vibe_vision/synthetic/renderer.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "synthetic/picture_moments.hpp"
#include "vibe_testing/expect_error.hpp"

namespace vibe::vision::renderer_test {
namespace {

Moments ringMoments(const SyntheticScene& scene, std::uint64_t index = 0) {
  return momentsOf(blackPart(scene, index), scene.camera.width);
}

/// A ring that passes the given slide at time 0 [m, m/s].
SyntheticScene movingRing(double slide, double speed, double exposure) {
  SyntheticScene scene = restingScene(1, slide);
  scene.instruments[0].nominal.axis.direction = {1, 0};
  scene.instruments[0].nominal.axis.perspective = 0;
  scene.instruments[0].motion.slide = [=](double time) { return slide + speed * time; };
  scene.degradation.exposure = exposure;
  return scene;
}

double pixelAt(const std::vector<float>& picture, int x, int y) {
  return picture[static_cast<std::size_t>(y * 728 + x)];
}

TEST(Renderer, BlurWidensAPictureByItsVarianceAndThatOfAPixel) {
  SyntheticScene scene = movingRing(0.0021, 0, 1e-3);
  scene.degradation.blur = 0;
  const Moments sharp = ringMoments(scene);
  const double ring = (20.0 * 20 + 10 * 10) / 4;  // variance of an annulus: (R^2 + r^2) / 4
  EXPECT_NEAR(sharp.variance.x(), ring + 1.0 / 12, 0.05);
  for (const double sigma : {0.3, 0.6, 1.0, 2.0}) {
    scene.degradation.blur = sigma;
    const Moments blurred = ringMoments(scene);
    EXPECT_NEAR(blurred.variance.x() - sharp.variance.x(), sigma * sigma, 0.01 + 0.002 * sigma * sigma) << sigma;
    EXPECT_NEAR(blurred.variance.y() - sharp.variance.y(), sigma * sigma, 0.01 + 0.002 * sigma * sigma) << sigma;
    EXPECT_LT((blurred.centroid - sharp.centroid).norm(), 5e-4) << sigma;
  }
}

TEST(Renderer, MotionWidensAPictureAlongTheAxisOnly) {
  const Moments still = ringMoments(movingRing(0.0021, 0, 1e-3));
  for (const double pixels : {0.7, 5.0, 20.0}) {
    const Moments moved = ringMoments(movingRing(0.0021, 0.5, pixels * 1e-4 / 0.5));
    EXPECT_NEAR(moved.variance.x() - still.variance.x(), pixels * pixels / 12, 0.01 + 1e-3 * pixels * pixels) << pixels;
    EXPECT_NEAR(moved.variance.y(), still.variance.y(), 0.01) << pixels;
  }
}

TEST(Renderer, TruthIsAtTheMiddleOfTheExposure) {
  for (const double exposure : {1e-3, 4e-3}) {
    const SyntheticScene scene = movingRing(-0.0032, 0.5, exposure);
    for (const std::uint64_t index : {0, 1}) {
      const double time = static_cast<double>(index) / scene.rate, drawn = ringMoments(scene, index).centroid.x();
      EXPECT_NEAR(drawn, truthAt(scene, 0, time).pixel.x(), 1e-3);
      // Control: the start of the exposure is elsewhere.
      EXPECT_GT(std::abs(drawn - truthAt(scene, 0, time - exposure / 2).pixel.x()), 2);
    }
  }
}

TEST(Renderer, RenderedFramesTellTimeAndTruth) {
  const SyntheticScene scene = standardScene();
  const RenderedFrame rendered = Renderer(scene).render(5, 1000);
  EXPECT_EQ(rendered.frame.sequence, 5u);
  EXPECT_DOUBLE_EQ(rendered.frame.stamp, 1000 + 5 / 147.0);
  EXPECT_DOUBLE_EQ(rendered.frame.exposure, 1e-3);
  EXPECT_EQ(rendered.frame.sensor_width, 728);
  ASSERT_EQ(rendered.truth.size(), 2u);
  for (std::size_t i = 0; i < 2; ++i) {
    const SyntheticInstrument& object = scene.instruments[i];
    const SyntheticTruth& truth = rendered.truth[i];
    EXPECT_DOUBLE_EQ(truth.slide, object.motion.slide(5 / 147.0));
    EXPECT_DOUBLE_EQ(truth.rotation, object.motion.rotation(5 / 147.0));
    EXPECT_NEAR(truth.along, alongOf(object.nominal.axis, truth.slide), 0.01);  // but for the lateral offset
    EXPECT_NEAR(truth.lateral, object.lateral * 1e4, 0.01);
    const double speed = (object.motion.slide(5 / 147.0 + 1e-6) - object.motion.slide(5 / 147.0 - 1e-6)) / 2e-6;
    EXPECT_NEAR(truth.velocity / (speed * 1e4), 1, 2e-3);
  }
}

/// Slope and value at 0 of the variance of single pixels against their mean, over frames of a scene at rest.
std::pair<double, double> photonTransfer(const SyntheticScene& scene) {
  constexpr int kFrames = 60;
  const Renderer renderer(scene);
  std::vector<double> sum(728 * 544), squares(728 * 544);
  for (int k = 0; k < kFrames; ++k) {
    const Frame frame = renderer.render(static_cast<std::uint64_t>(k)).frame;
    for (std::size_t i = 0; i < sum.size(); ++i) {
      sum[i] += frame.image.data[i];
      squares[i] += static_cast<double>(frame.image.data[i]) * frame.image.data[i];
    }
  }
  const std::vector<float> expected = renderer.renderExpected(0);
  double n = 0, x = 0, y = 0, xx = 0, xy = 0, bias = 0;
  for (std::size_t i = 0; i < sum.size(); ++i) {
    const double mean = sum[i] / kFrames, variance = (squares[i] - kFrames * mean * mean) / (kFrames - 1);
    n += 1;
    x += expected[i];
    y += variance;
    xx += static_cast<double>(expected[i]) * expected[i];
    xy += expected[i] * variance;
    bias += mean - expected[i];
  }
  EXPECT_NEAR(bias / n, 0, 0.003);
  const double slope = (n * xy - x * y) / (n * xx - x * x);
  return {slope, (y - slope * x) / n};
}

TEST(Renderer, NoiseFollowsThePhotonTransferCurve) {
  for (const PixelNoise& noise : {PixelNoise{0.096, 0.6}, PixelNoise{0.38, 2.4}, PixelNoise{0, 0.6}}) {
    SyntheticScene scene = namedScene("static");
    scene.degradation.noise = noise;
    const auto [slope, dark] = photonTransfer(scene);
    EXPECT_NEAR(slope, noise.gain, 1e-3 + 0.01 * noise.gain);
    EXPECT_NEAR(dark, noise.read * noise.read, 0.05 + 0.02 * noise.read * noise.read);
  }
}

TEST(Renderer, NoiseOfPixelsAndFramesIsIndependent) {
  const Renderer renderer(namedScene("static"));
  const std::vector<float> expected = renderer.renderExpected(0);
  const Frame a = renderer.render(0).frame, b = renderer.render(1).frame;
  double own = 0, right = 0, below = 0, next = 0;
  for (std::size_t i = 0; i + 728 < expected.size(); ++i) {
    const double noise = a.image.data[i] - expected[i];
    own += noise * noise;
    right += noise * (a.image.data[i + 1] - expected[i + 1]);
    below += noise * (a.image.data[i + 728] - expected[i + 728]);
    next += noise * (b.image.data[i] - expected[i]);
  }
  EXPECT_LT(std::abs(right / own), 0.01);  // 6 standard deviations
  EXPECT_LT(std::abs(below / own), 0.01);
  EXPECT_LT(std::abs(next / own), 0.01);
}

std::uint64_t sumOf(const Frame& frame) {
  std::uint64_t hash = 14695981039346656037ULL;
  for (int i = 0; i < frame.image.width * frame.image.height; ++i)
    hash = (hash ^ frame.image.data[i]) * 1099511628211ULL;
  return hash;
}

TEST(Renderer, AFrameIsTheSameWheneverItIsDrawn) {
  for (const std::string name : {"moving", "tilt", "all"}) {
    const Renderer renderer(namedScene(name));
    const std::uint64_t third = sumOf(renderer.render(3).frame);
    const std::uint64_t fourth = sumOf(renderer.render(4).frame);
    EXPECT_EQ(sumOf(renderer.render(3, 77).frame), third) << name;
    EXPECT_EQ(sumOf(Renderer(namedScene(name)).render(3).frame), third) << name;
    EXPECT_NE(fourth, third) << name;
    SyntheticScene other = namedScene(name);
    other.seed = 2;
    EXPECT_NE(sumOf(Renderer(other).render(3).frame), third) << name;
  }
}

TEST(Renderer, LightFlickersDriftsAndFallsOffTowardsTheCorners) {
  SyntheticScene scene = restingScene(1, 0);
  const std::vector<float> full = Renderer(scene).renderExpected(0);
  scene.degradation.vignetting = 0.3;
  const std::vector<float> dimmed = Renderer(scene).renderExpected(0);
  EXPECT_NEAR(pixelAt(dimmed, 0, 0) / pixelAt(full, 0, 0), 0.7, 1e-3);
  EXPECT_NEAR(pixelAt(dimmed, 364, 272) / pixelAt(full, 364, 272), 1, 1e-3);

  scene.degradation.vignetting = 0;
  scene.degradation.flicker = 0.12;
  scene.rate = 400;  // four frames in a period
  const Renderer flickering(scene);
  for (const std::uint64_t k : {0, 1, 2, 3}) {
    // The mean over 1 ms of a sine at 100 Hz is weaker by sin(0.1 pi) / (0.1 pi).
    const double light = 1 + 0.12 * std::sin(M_PI / 2 * static_cast<double>(k)) * std::sin(0.1 * M_PI) / (0.1 * M_PI);
    const std::vector<float> picture = flickering.renderExpected(k);
    EXPECT_NEAR(pixelAt(picture, 50, 400) / pixelAt(full, 50, 400), light, 1e-4);
    EXPECT_NEAR(pixelAt(picture, 360, 268) / pixelAt(full, 360, 268), light, 1e-4);  // on the marker
  }
  scene.degradation.flicker = 0;
  scene.degradation.drift = 0.2;
  const Renderer drifting(scene);
  EXPECT_NEAR(pixelAt(drifting.renderExpected(200), 50, 400) / pixelAt(full, 50, 400), 0.9, 1e-3);  // after 0.5 s
  EXPECT_NEAR(pixelAt(drifting.renderExpected(400), 50, 400) / pixelAt(full, 50, 400), 0.8, 1e-3);
}

TEST(Renderer, VisibleShareIsWhatTheBarLeaves) {
  SyntheticScene scene = restingScene(1, 0.001);
  scene.degradation.occluder = true;
  scene.degradation.drift = 0;
  SyntheticScene free = scene;
  free.degradation.occluder = false;
  const Renderer renderer(scene);
  const std::vector<double> all = blackPart(free, 0);
  const double area = momentsOf(all, 728).area;
  int covered = 0, partly = 0, open = 0;
  for (std::uint64_t k = 0; k < 70; ++k) {  // the bar comes, covers the ring and leaves
    const double visible = truthAt(scene, 0, static_cast<double>(k) / scene.rate).visible;
    const double black = std::max(0.0, momentsOf(blackPart(scene, k), 728).area / area);
    covered += visible == 0 ? 1 : 0;
    open += visible == 1 ? 1 : 0;
    partly += visible > 0.1 && visible < 0.9 ? 1 : 0;
    // The ring has a hole, the disc has not: the shares may differ a little in between.
    EXPECT_NEAR(black, visible, visible == 0 || visible == 1 ? 0.02 : 0.12) << k;
    EXPECT_EQ(truthAt(free, 0, static_cast<double>(k) / scene.rate).visible, 1);
    if (visible == 1) k += 3;
  }
  EXPECT_GE(covered, 1);
  EXPECT_GE(partly, 2);
  EXPECT_GE(open, 2);
}

TEST(Renderer, VisibleShareFallsBeyondTheImage) {
  SyntheticScene scene = restingScene(1, 0);
  scene.instruments[0].nominal.axis.origin.x() = -0.5;  // the edge cuts the ring in the middle
  EXPECT_NEAR(truthAt(scene, 0, 0).visible, 0.5, 0.04);
  scene.instruments[0].nominal.axis.origin.x() = -30;
  EXPECT_EQ(truthAt(scene, 0, 0).visible, 0);
  EXPECT_NO_THROW(Renderer(scene).render(0));
}

TEST(Renderer, HighlightsSaturateAndStayWhileTheMarkerMoves) {
  SyntheticScene scene = movingRing(0, 0.3, 1e-4);
  const std::vector<float> without = Renderer(scene).renderExpected(0);
  EXPECT_LT(*std::max_element(without.begin(), without.end()), 200);
  scene.degradation.highlights = 2;
  const Renderer renderer(scene);
  const std::vector<float> first = renderer.renderExpected(0), second = renderer.renderExpected(1);  // 20 px later
  int saturated = 0, stay = 0;
  for (std::size_t i = 0; i < first.size(); ++i) {
    if (first[i] > 255) ++saturated;
    if (first[i] > 255 && second[i] > 255) ++stay;
  }
  EXPECT_GT(saturated, 40);
  EXPECT_GT(stay, saturated / 3);
  EXPECT_EQ(renderer.render(0).frame.image.data[std::max_element(first.begin(), first.end()) - first.begin()], 255);
}

TEST(Renderer, TheLookAlikeIsSmallerAndPassesBeside) {
  SyntheticScene scene = restingScene(1, 0.001);
  const double area = momentsOf(blackPart(scene, 0), 728).area;
  scene.degradation.look_alike = true;
  const std::vector<double> both = blackPart(scene, 0);
  EXPECT_NEAR(momentsOf(both, 728).area / area, 1 + 0.75 * 0.75, 2e-3);
  // Rows of the marker show the marker only.
  const auto y = static_cast<std::ptrdiff_t>(truthAt(scene, 0, 0).pixel.y());
  const std::vector<double> rows(both.begin() + (y - 25) * 728, both.begin() + (y + 26) * 728);
  EXPECT_NEAR(momentsOf(rows, 728).area / area, 1, 2e-3);
}

TEST(Renderer, TilesAreWithoutSeams) {
  // A marker of no contrast to the background, on a background without texture, cannot be seen.
  SyntheticScene scene = namedScene("moving");
  const std::vector<float> image = Renderer(scene).renderExpected(0);
  for (SyntheticInstrument& instrument : scene.instruments) instrument.nominal.axis.origin.y() += 5000;
  const std::vector<float> empty = Renderer(scene).renderExpected(0);
  int same = 0;
  double largest = 0;
  for (std::size_t i = 0; i < image.size(); ++i) {
    const double difference = std::abs(static_cast<double>(image[i]) - empty[i]);
    const int y = static_cast<int>(i) / 728;
    if (y < 90 || y > 300 || (y > 150 && y < 190)) largest = std::max(largest, difference);
    same += difference == 0 ? 1 : 0;
  }
  EXPECT_LT(largest, 1e-3);
  EXPECT_LT(same, 728 * 544 - 5000);  // the markers are there
}

TEST(Renderer, UnknownScenesAreNamedTogetherWithTheKnownOnes) {
  EXPECT_ERROR(namedScene("movin"), "'movin'");
  EXPECT_ERROR(namedScene("movin"), "moving");
}

}  // namespace
}  // namespace vibe::vision::renderer_test
