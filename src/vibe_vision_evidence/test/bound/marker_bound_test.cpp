#include "bound/marker_bound.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "synthetic/picture_moments.hpp"
#include "vibe_vision/synthetic/renderer.hpp"

namespace vibe::vision::evidence::marker_bound_test {
namespace {

double ringBound(double diameter, const PixelNoise& noise = {}) {
  SyntheticScene scene = restingScene(1, 0.0021);
  scene.instruments[0].nominal.marker = RingDesign{diameter, diameter / 2, 1.75 * diameter};
  scene.degradation.noise = noise;
  return cramerRaoBound(scene, 0, 0).along;
}

TEST(MarkerBound, OfARingIsThatOfItsEdges) {
  // Constant noise: the information of a straight edge per pixel of its length is contrast^2 / (2 sqrt(pi) s variance),
  // if a Gaussian of deviation s blurs it; cos^2 of its direction counts. s^2 = 0.6^2 + 1/12 for the pixel.
  const double deviation = 5, length = M_PI * (20 + 10), width = std::sqrt(0.36 + 1.0 / 12);
  const double information = 145.0 * 145 * length / (2 * std::sqrt(M_PI) * width * deviation * deviation);
  EXPECT_NEAR(ringBound(4e-3, {0, deviation}) * std::sqrt(information), 1, 0.02);
}

TEST(MarkerBound, OfRingsOfSeveralSizesInTheRatioOfTheSurvey) {
  // 0.0039, 0.0032, 0.00245 and 0.0019 px for 16, 24, 40 and 64 px, at another contrast.
  const double medium = ringBound(4e-3);
  EXPECT_NEAR(medium, 0.00245, 0.0009);
  EXPECT_NEAR(ringBound(1.6e-3) / medium, 0.0039 / 0.00245, 0.05);
  EXPECT_NEAR(ringBound(2.4e-3) / medium, 0.0032 / 0.00245, 0.05);
  EXPECT_NEAR(ringBound(6.4e-3) / medium, 0.0019 / 0.00245, 0.05);
}

TEST(MarkerBound, GrowsWithTheNoiseAndTheBlur) {
  const double usual = ringBound(4e-3, {0.1, 0.0});
  EXPECT_NEAR(ringBound(4e-3, {0.4, 0.0}) / usual, 2, 1e-6);
  SyntheticScene scene = restingScene(1, 0.0021);
  scene.degradation.noise = {0.1, 0.0};
  scene.degradation.blur = 2;
  EXPECT_GT(cramerRaoBound(scene, 0, 0).along, 1.5 * usual);
}

TEST(MarkerBound, OfASleeveShowsItsRotation) {
  const MarkerBound bound = cramerRaoBound(restingScene(0, 0.0021, 0.7), 0, 0);
  EXPECT_GT(bound.along, 0.001);
  EXPECT_LT(bound.along, 0.003);
  EXPECT_GT(bound.rotation, 0.02 * M_PI / 180);
  EXPECT_LT(bound.rotation, 0.1 * M_PI / 180);
  EXPECT_EQ(cramerRaoBound(restingScene(1, 0.0021), 0, 0).rotation, 0);
}

/// Best linear estimate of a small displacement from one noisy frame: it reaches the bound of a known place nearly.
TEST(MarkerBound, IsTheScatterOfLeastSquares) {
  SyntheticScene scene = restingScene(1, 0.0021);
  const Renderer renderer(scene);
  const std::vector<float> expected = renderer.renderExpected(0);
  const auto moved = [&](double by) {
    SyntheticScene other = scene;
    other.instruments[0].motion.slide = [by](double) { return 0.0021 + by; };
    return Renderer(other).renderExpected(0);
  };
  const std::vector<float> right = moved(5e-6), left = moved(-5e-6);
  const Eigen::Vector2d centre = truthAt(scene, 0, 0).pixel;
  const auto gradientAt = [&](std::size_t i) {
    const Eigen::Vector2d pixel(static_cast<int>(i) % 728, static_cast<int>(i) / 728);
    return (pixel - centre).norm() < 28 ? (right[i] - left[i]) / 0.1 : 0.0;
  };
  double sum = 0, squares = 0;
  constexpr int kFrames = 300;
  for (int k = 0; k < kFrames; ++k) {
    const Frame frame = renderer.render(static_cast<std::uint64_t>(k)).frame;
    double moment = 0, normal = 0;
    for (std::size_t i = 0; i < expected.size(); ++i) {
      const double gradient = gradientAt(i);
      if (gradient == 0) continue;
      const double weight = 1 / (0.096 * expected[i] + 0.36);
      moment += weight * gradient * (frame.image.data[i] - expected[i]);
      normal += weight * gradient * gradient;
    }
    sum += moment / normal;
    squares += moment / normal * moment / normal;
  }
  const double bound = cramerRaoBound(scene, 0, 0).along;
  EXPECT_NEAR(std::sqrt(squares / kFrames) / bound, 1, 0.12);  // 3 standard deviations of 300 frames
  EXPECT_NEAR(sum / kFrames, 0, 4 * bound / std::sqrt(kFrames));
}

TEST(MarkerBound, NeedsAMarkerThatIsSeen) {
  SyntheticScene scene = restingScene(1, 0);
  scene.instruments[0].nominal.axis.origin.x() = -100;
  EXPECT_THROW(cramerRaoBound(scene, 0, 0), std::exception);
}

}  // namespace
}  // namespace vibe::vision::evidence::marker_bound_test
