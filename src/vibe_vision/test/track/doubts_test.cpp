// What speaks against camera or calibration although the marker is tracked.
#include <gtest/gtest.h>

#include "track/ring_scene.hpp"

namespace vibe::vision::doubts_test {
namespace {

using test::rest;
using test::ringScene;

constexpr double kAmplitude = 60;          // of the motion [px]
constexpr double kAngular = 2 * M_PI * 5;  // [rad/s]

double placeAt(double time) {
  return kAmplitude * std::sin(kAngular * time);
}

/// A picture at rest as a camera shows it that moves, row by row [s]. The stamp is that of row 0.
std::vector<std::uint8_t> moved(const ImageView& still, double stamp, double row_time) {
  std::vector<std::uint8_t> pixels;
  for (int y = 0; y < still.height; ++y)
    for (int x = 0; x < still.width; ++x) {
      const double from = std::clamp(x - placeAt(stamp + y * row_time), 0.0, still.width - 2.0);
      const auto i = static_cast<int>(from);
      const double f = from - i;
      pixels.push_back(static_cast<std::uint8_t>(std::lround((1 - f) * still.row(y)[i] + f * still.row(y)[i + 1])));
    }
  return pixels;
}

struct Result {
  int tracked = 0, doubtful = 0;
  double most_deviations = 0;  ///< of the frames that are doubtful
};

Result follow(double row_time) {
  SyntheticScene scene = ringScene("static");
  rest(scene, 0);
  const RenderedFrame still = Renderer(scene).render(0);
  Tracker tracker(nominalConfig(scene));
  Result result;
  for (int k = 0; k < 40; ++k) {
    Frame frame = still.frame;
    frame.stamp = k / 147.0, frame.exposure = 1e-5;
    const std::vector<std::uint8_t> pixels = moved(still.frame.image, frame.stamp, row_time);
    frame.image.data = pixels.data(), frame.image.stride = frame.image.width;
    const Measurement& m = tracker.track(frame)[0];
    result.tracked += m.tracked() ? 1 : 0;
    if (m.doubt != Doubt::Shutter) continue;
    ++result.doubtful;
    const double error = m.along - still.truth[0].along - placeAt(frame.stamp);
    result.most_deviations = std::max(result.most_deviations, std::abs(error) / std::sqrt(m.along_variance));
  }
  return result;
}

TEST(Doubts, ARollingShutterIsSeenAndItsErrorStated) {
  const Result result = follow(1e-5);
  EXPECT_GT(result.tracked, 20);  // at full speed the ring looks too oblique
  EXPECT_LE(result.tracked - result.doubtful, 6);
  EXPECT_LT(result.most_deviations, 3);
}

TEST(Doubts, AGlobalShutterRaisesNone) {
  const Result result = follow(0);
  EXPECT_GT(result.tracked, 35);
  EXPECT_EQ(result.doubtful, 0);
}

Doubt doubtOfSize(double scale) {
  SyntheticScene scene = ringScene("static");
  scene.instruments[0].scale = scale;
  const Renderer renderer(scene);
  Tracker tracker(nominalConfig(scene));
  Measurement last;
  for (std::uint64_t i = 0; i < 40; ++i) last = tracker.track(renderer.render(i).frame)[0];
  EXPECT_TRUE(last.tracked());
  return last.doubt;
}

TEST(Doubts, AnotherSizeThanCalibrated) {
  EXPECT_EQ(doubtOfSize(1.03), Doubt::Size);
  EXPECT_EQ(doubtOfSize(0.97), Doubt::Size);
  EXPECT_EQ(doubtOfSize(1.005), Doubt::None);
}

}  // namespace
}  // namespace vibe::vision::doubts_test
