#include "vibe_vision/calibrate/calibration_check.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <set>

#include "calibrate/instrument_check.hpp"
#include "vibe_vision/synthetic/renderer.hpp"

namespace vibe::vision::calibration_check_test {
namespace {

constexpr std::uint64_t kFrames = 80;  // at 147 Hz half a period and a little more

/// The two instruments go to and fro behind a lens that moves the corners by 6 %.
SyntheticScene movingScene() {
  SyntheticScene scene = namedScene("light");
  scene.degradation.flicker = scene.degradation.drift = 0;
  scene.instruments[0].motion.slide = [](double t) { return 0.025 * std::cos(2 * M_PI * t); };
  scene.instruments[0].motion.rotation = [](double t) { return 2 * std::sin(2 * M_PI * 0.7 * t); };
  scene.instruments[1].motion.slide = [](double t) { return 0.022 * std::cos(2 * M_PI * t + 0.2); };
  return scene;
}

using Pictures = std::vector<RenderedFrame>;

const Pictures& pictures() {
  static const Pictures all = [] {
    const Renderer renderer(movingScene());
    Pictures frames;
    for (std::uint64_t k = 0; k < kFrames; ++k) frames.push_back(renderer.render(k));
    return frames;
  }();
  return all;
}

std::vector<CheckedInstrument> check(const VisionConfig& config, const Pictures& frames = pictures()) {
  CalibrationCheck check(config);
  for (const RenderedFrame& frame : frames) check.add(frame.frame);
  return check.result();
}

/// "helix scale" and so on.
std::set<std::string> namesOf(Verdict verdict, const std::vector<CheckedInstrument>& result) {
  std::set<std::string> names;
  for (const CheckedInstrument& instrument : result)
    for (const CheckedQuantity& q : instrument.quantities)
      if (q.verdict == verdict) names.insert(instrument.name + " " + q.name);
  return names;
}

CheckedQuantity quantity(const std::vector<CheckedInstrument>& result, std::size_t instrument,
                         const std::string& name) {
  for (const CheckedQuantity& q : result.at(instrument).quantities)
    if (q.name == name) return q;
  ADD_FAILURE() << name;
  return {};
}

using Names = std::set<std::string>;

TEST(CalibrationCheck, ARightCalibrationHolds) {
  const auto result = check(nominalConfig(movingScene()));
  EXPECT_EQ(namesOf(Verdict::Wrong, result), Names());
  EXPECT_EQ(namesOf(Verdict::Unknown, result), Names());
  EXPECT_EQ(result[0].tracked, kFrames);
  EXPECT_LT(std::abs(quantity(result, 0, "scale").value), 5e-4);
  EXPECT_LT(quantity(result, 0, "shutter").deviation, 1e-5);
}

TEST(CalibrationCheck, AScaleThatIsTwoPerCentWrong) {
  VisionConfig config = nominalConfig(movingScene());
  config.instruments[0].axis.pixels_per_metre *= 1.02;
  const auto one = check(config);
  EXPECT_EQ(namesOf(Verdict::Wrong, one), Names{"helix scale"});
  EXPECT_NEAR(quantity(one, 0, "scale").value, 1 / 1.02 - 1, 5e-4);
  EXPECT_EQ(quantity(one, 0, "scale").text.find("all instruments"), std::string::npos);
  config.instruments[1].axis.pixels_per_metre *= 1.02;
  const auto both = check(config);
  EXPECT_EQ(namesOf(Verdict::Wrong, both), (Names{"helix scale", "needle_driver scale"}));
  EXPECT_NE(quantity(both, 0, "scale").text.find("all instruments"), std::string::npos);
}

/// The tilt of its bars makes a turning sleeve look askew; that is not said.
TEST(CalibrationCheck, AnAxisThatIsTurnedByADegree) {
  VisionConfig config = nominalConfig(movingScene());
  SlideAxis& axis = config.instruments[0].axis;
  axis.direction = Eigen::Rotation2Dd(M_PI / 180) * axis.direction;
  const auto result = check(config);
  EXPECT_EQ(namesOf(Verdict::Wrong, result), Names{"helix direction"});
  const CheckedQuantity direction = quantity(result, 0, "direction");
  EXPECT_NEAR(direction.value, -M_PI / 180, 3 * direction.deviation);
  EXPECT_LT(direction.deviation, 5e-4);
}

TEST(CalibrationCheck, AFocalLengthThatIsTenPerCentWrong) {
  VisionConfig config = nominalConfig(movingScene());
  config.camera.fx *= 1.1, config.camera.fy *= 1.1;
  const Names wrong = namesOf(Verdict::Wrong, check(config));
  EXPECT_EQ(wrong, (Names{"helix lens", "helix path"}));
}

TEST(CalibrationCheck, AFocalLengthThatIsFivePerCentWrongBehindALensThatBendsLess) {
  SyntheticScene scene = movingScene();
  for (double& k : scene.degradation.distortion) k /= 6;
  scene.camera.distortion = scene.degradation.distortion;
  const Renderer renderer(scene);
  Pictures frames;
  for (std::uint64_t k = 0; k < kFrames; k += 2) frames.push_back(renderer.render(k));
  VisionConfig config = nominalConfig(scene);
  EXPECT_EQ(namesOf(Verdict::Wrong, check(config, frames)), Names());
  config.camera.fx *= 1.05, config.camera.fy *= 1.05;
  const auto result = check(config, frames);
  EXPECT_EQ(namesOf(Verdict::Wrong, result), Names{"helix lens"});
  EXPECT_NE(quantity(result, 0, "lens").text.find("too long by about"), std::string::npos);
}

TEST(CalibrationCheck, AFocalLengthThatNothingShows) {
  SyntheticScene scene = movingScene();
  scene.degradation.distortion = scene.camera.distortion = {};
  const Renderer renderer(scene);
  Pictures frames;
  for (std::uint64_t k = 0; k < kFrames; k += 2) frames.push_back(renderer.render(k));
  VisionConfig config = nominalConfig(scene);
  config.camera.fx *= 1.05, config.camera.fy *= 1.05;
  const auto result = check(config, frames);
  EXPECT_EQ(quantity(result, 0, "lens").verdict, Verdict::Unknown);
  EXPECT_NE(quantity(result, 0, "lens").text.find("tilted to all sides"), std::string::npos);
}

TEST(CalibrationCheck, AnAxisThatIsSlantedOtherwise) {
  VisionConfig config = nominalConfig(movingScene());
  config.instruments[1].axis.perspective += 0.3;
  EXPECT_EQ(namesOf(Verdict::Wrong, check(config)), Names{"needle_driver perspective"});
}

TEST(CalibrationCheck, AMotionThatShowsLittleIsNoProof) {
  const auto result = check(nominalConfig(movingScene()), {pictures().begin(), pictures().begin() + 10});
  EXPECT_EQ(namesOf(Verdict::Wrong, result), Names());
  const Names unknown = namesOf(Verdict::Unknown, result);
  // and one picture again and again
  EXPECT_EQ(namesOf(Verdict::Wrong, check(nominalConfig(movingScene()), Pictures(3, pictures()[0]))), Names());
  for (const char* name : {"helix scale", "helix direction", "helix lens", "helix shutter", "needle_driver bent"})
    EXPECT_EQ(unknown.count(name), 1U) << name;
}

/// A sleeve that a tracker followed for 100 frames. @param turn  of the rod in each frame [rad]
std::vector<CheckedInstrument> followed(Doubt doubt, double speed, double turn) {
  const VisionConfig config = nominalConfig(movingScene());
  InstrumentCheck check(config.instruments[0], config.camera);
  for (int k = 0; k < 100; ++k) {
    Measurement m;
    m.reason = LostReason::None;
    m.slide = speed * k / 147.0;
    m.rotation = turn * k;
    m.doubt = k % 2 == 0 ? doubt : Doubt::None;
    check.follow(m, k / 147.0);
  }
  return {check.result()};
}

TEST(CalibrationCheck, DoubtsOfTheTrackerAreFaults) {
  for (const auto& [doubt, name] : {std::pair{Doubt::Shutter, "shutter"}, std::pair{Doubt::Askew, "askew"},
                                    std::pair{Doubt::Bent, "bent"}, std::pair{Doubt::Response, "response"}}) {
    EXPECT_EQ(namesOf(Verdict::Wrong, followed(doubt, 0.2, 0.1)), Names{std::string("helix ") + name});
    EXPECT_EQ(quantity(followed(Doubt::None, 0.2, 0.1), 0, name).verdict, Verdict::Holds) << name;
  }
  EXPECT_EQ(quantity(followed(Doubt::None, 0.01, 0.1), 0, "shutter").verdict, Verdict::Unknown);  // too slow to tell
  EXPECT_EQ(quantity(followed(Doubt::None, 0.2, 0), 0, "askew").verdict, Verdict::Unknown);       // did not turn
  EXPECT_EQ(quantity(followed(Doubt::None, 0.2, 0), 0, "bent").verdict, Verdict::Holds);
}

}  // namespace
}  // namespace vibe::vision::calibration_check_test
