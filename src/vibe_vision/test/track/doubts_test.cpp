// What speaks against camera or calibration although the marker is tracked.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>

#include "track/calibration_doubts.hpp"
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

/// What may be wrong with camera or marker.
struct Fault {
  double row_time = 0;  ///< [s]
  double bend = 0;      ///< by how much the rim of the ring is nearer to its centre along the axis, of its radius
  double relief = 0;    ///< by how much the rim of the ring is nearer to the camera than its centre, of its radius
};

/// A picture at rest as a camera shows it that moves, row by row. The stamp is that of row 0.
std::vector<std::uint8_t> moved(const ImageView& still, double centre, double stamp, const Fault& fault) {
  constexpr double kRadius = 20, kFocalLength = 4600;  // of the ring, of the camera [px]
  std::vector<std::uint8_t> pixels;
  for (int y = 0; y < still.height; ++y)
    for (int x = 0; x < still.width; ++x) {
      const double to = x - placeAt(stamp + y * fault.row_time) - centre;
      const double bent = to * (1 + fault.bend * std::min(1.0, to * to / (kRadius * kRadius)));
      const double seen_from = (x - still.width / 2.0) / kFocalLength;
      const double raised = bent - seen_from * fault.relief * std::min(to * to, 2 * kRadius * kRadius) / kRadius;
      const double from = std::clamp(centre + raised, 0.0, still.width - 2.0);
      const auto i = static_cast<int>(from);
      const double f = from - i;
      pixels.push_back(static_cast<std::uint8_t>(std::lround((1 - f) * still.row(y)[i] + f * still.row(y)[i + 1])));
    }
  return pixels;
}

struct Result {
  int tracked = 0, silent = 0;  ///< silent: wrong by more than 0.5 mm without doubt
  std::map<Doubt, int> doubts;
  double most_deviations = 0;  ///< of the frames with doubts of the shutter
};

Result follow(const Fault& fault) {
  SyntheticScene scene = ringScene("static");
  rest(scene, 0);
  const RenderedFrame still = Renderer(scene).render(0);
  Tracker tracker(nominalConfig(scene));
  Result result;
  for (int k = 0; k < 40; ++k) {
    Frame frame = still.frame;
    frame.stamp = k / 147.0, frame.exposure = 1e-5;
    const std::vector<std::uint8_t> pixels = moved(still.frame.image, still.truth[0].pixel.x(), frame.stamp, fault);
    frame.image.data = pixels.data(), frame.image.stride = frame.image.width;
    const Measurement& m = tracker.track(frame)[0];
    result.tracked += m.tracked() ? 1 : 0;
    ++result.doubts[m.doubt];
    const double error = m.along - still.truth[0].along - placeAt(frame.stamp);
    result.silent += std::abs(error) > 5 && m.doubt == Doubt::None ? 1 : 0;
    if (m.doubt != Doubt::Shutter) continue;
    result.most_deviations = std::max(result.most_deviations, std::abs(error) / std::sqrt(m.along_variance));
  }
  return result;
}

TEST(Doubts, ARollingShutterIsSeenAndItsErrorStated) {
  Result result = follow({1e-5, 0});
  EXPECT_GT(result.tracked, 20);  // at full speed the ring looks too oblique
  EXPECT_LE(result.tracked - result.doubts[Doubt::Shutter], 6);
  EXPECT_EQ(result.silent, 0);
  EXPECT_LT(result.most_deviations, 3);
}

TEST(Doubts, AGlobalShutterAndAFlatMarkerRaiseNoneAfterTheFirstFrames) {
  Result result = follow({});
  EXPECT_GT(result.tracked, 35);
  EXPECT_GE(result.doubts[Doubt::Unchecked], 1);
  EXPECT_LE(result.doubts[Doubt::Unchecked], 6);
  EXPECT_EQ(result.doubts[Doubt::None] + result.doubts[Doubt::Unchecked], result.tracked);
}

TEST(Doubts, ABentMarker) {
  EXPECT_GT(follow({0, 0.0067}).doubts[Doubt::Bent], 20);  // a sheet around something of 20 mm
}

/// A sheet that falls away from the camera to both sides does so wherever it is seen from; it shows at the side only.
TEST(Doubts, AMarkerWhoseEndsAreNotAsFarAsItsMiddle) {
  EXPECT_GT(follow({0, 0, -0.15}).doubts[Doubt::Bent], 10);
  EXPECT_EQ(follow({0, 0, -0.01}).doubts[Doubt::Bent], 0);
}

/// Of a sleeve whose ends are moved by `shift` px in every frame, and by `relief` px per slope of the line of sight.
/// @param uneven  such shifts that are usual [px]
Doubt doubtOfEnds(double shift, double relief, double uneven) {
  CalibrationDoubts doubts(1);
  for (int k = 0; k < 20; ++k) {
    const double slope = 0.015 + 0.02 * std::cos(0.3 * k);
    doubts.addRelief({shift / slope + relief, 0.25 / (slope * slope * 1000)}, 50, slope, uneven);
  }
  return doubts.doubt();
}

TEST(Doubts, OpticsThatMoveTheBarsApartAreNoRelief) {
  EXPECT_EQ(doubtOfEnds(0.04, 0, 0.02), Doubt::None);
  EXPECT_EQ(doubtOfEnds(0.04, 0, 0), Doubt::Bent);
  EXPECT_EQ(doubtOfEnds(0.01, 3, 0.01), Doubt::Bent);
  EXPECT_EQ(doubtOfEnds(0.01, -3, 0.01), Doubt::Bent);
}

/// At rest, after a motion.
/// @param motion  [m]
Doubt doubtAtRest(double scale, double motion = 1e-3) {
  SyntheticScene scene = ringScene("static");
  scene.instruments[0].scale = scale;
  test::moveAs(scene, [motion](double time) { return motion * std::min(1.0, 10 * time); });
  const Renderer renderer(scene);
  Tracker tracker(nominalConfig(scene));
  Measurement last;
  for (std::uint64_t i = 0; i < 40; ++i) last = tracker.track(renderer.render(i).frame)[0];
  EXPECT_TRUE(last.tracked());
  return last.doubt;
}

TEST(Doubts, AnotherSizeThanCalibrated) {
  EXPECT_EQ(doubtAtRest(1.03), Doubt::Size);
  EXPECT_EQ(doubtAtRest(0.97), Doubt::Size);
  EXPECT_EQ(doubtAtRest(1.005), Doubt::None);
}

/// What has not moved may be a copy, and the marker hidden. A pixel of motion is none.
TEST(Doubts, AMarkerIsUncheckedUntilItHasMoved) {
  EXPECT_EQ(doubtAtRest(1, 0), Doubt::Unchecked);
  EXPECT_EQ(doubtAtRest(1, 1e-4), Doubt::Unchecked);
  EXPECT_EQ(doubtAtRest(1, -1e-3), Doubt::None);
}

/// What a sleeve shows of a tilt [rad] that is constant, of one of its print, and of a row time [s].
Doubt doubtOfSleeve(double constant, double askew, double row_time) {
  CalibrationDoubts doubts(1);
  for (int k = 0; k < 40; ++k) {
    const double phase = 0.2265 * k, speed = 5e3 * std::cos(phase), rotation = 0.4 + 0.9 * std::sin(phase + 0.6);
    const double shear = speed * row_time - askew * std::cos(rotation - 1);
    doubts.addShear({shear, 1e-6}, speed, constant, rotation);
  }
  return doubts.doubt();
}

TEST(Doubts, ASleeveThatIsAskewIsNotARollingShutter) {
  EXPECT_EQ(doubtOfSleeve(0, 0, 0), Doubt::None);
  EXPECT_EQ(doubtOfSleeve(0.1, 0.005, 0), Doubt::None);
  EXPECT_EQ(doubtOfSleeve(0.1, 0.035, 0), Doubt::Askew);
  EXPECT_EQ(doubtOfSleeve(0.1, 0.035, 1e-5), Doubt::Shutter);
}

/// A sleeve that is askew and turns so that its tilt follows its speed. @param sure  another marker has shown that all
/// rows are exposed at the same time
Doubt doubtOfTurningSleeve(bool sure) {
  CalibrationDoubts doubts(1);
  if (sure) doubts.addRowTime({1e14, 0});
  for (int k = 0; k < 40; ++k) {
    const double along = std::cos(0.2265 * k);
    doubts.addShear({0.0175 * along, 1e-6}, 5e3 * along, 0, std::acos(-0.5 * along));
  }
  return doubts.doubt();
}

TEST(Doubts, TheShutterIsThatOfAllMarkers) {
  EXPECT_EQ(doubtOfTurningSleeve(false), Doubt::Shutter);
  EXPECT_EQ(doubtOfTurningSleeve(true), Doubt::Askew);
}

}  // namespace
}  // namespace vibe::vision::doubts_test
