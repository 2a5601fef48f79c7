// The closed loop with the tissue: simulator -> parameters -> firmware -> hand -> simulator. The force of the motor is
// compared with that of a simulation of a thousand steps per second along the same motion.
#include "vibe_hardware/emulator/haptic_loop.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>

#include "vibe_core/files/files.hpp"
#include "vibe_core/scene/scene_parser.hpp"
#include "vibe_hardware/emulator/hand.hpp"

namespace vibe::hardware::haptic_loop_test {
namespace {

// scenes name the URDF of the scope by its package
const int kPackages = ::setenv("ROS_PACKAGE_PATH", std::filesystem::absolute("../..").c_str(), 1);

HapticLoopSettings settingsOf(const std::string& script_file, double from) {
  const TraineeScript script = TraineeScript::load(resolveAddress(script_file));
  HapticLoopSettings settings;
  settings.setup.calibration = Calibration::load("../config/devices.yaml");
  settings.hand = std::make_shared<ScriptedHand>(script);
  settings.measure_from = from;
  settings.duration = script.duration();
  return settings;
}

RenderingError run(const Scene& scene, HapticLoopSettings settings, Rendering rendering) {
  settings.rendering = rendering;
  const HapticLoopResult result = runHapticLoop(scene, settings);
  EXPECT_GT(result.parameter_sets, 30);
  EXPECT_EQ(result.clamped, 0);
  EXPECT_EQ(result.refused, 0);
  EXPECT_EQ(result.mismatched, 0);
  const RenderingError error = renderingError(result.samples);
  std::printf(
      "%s: error %.1f mN of %.0f mN, delay %.1f ms; energy given by the motor %.2f mJ (at most %.2f), by the tissue "
      "%.2f mJ\n",
      rendering == Rendering::Spring ? "spring" : "held  ", 1e3 * error.rendered, 1e3 * error.change, 1e3 * error.delay,
      1e3 * error.motor_energy, 1e3 * error.most_energy, 1e3 * error.tissue_energy);
  // the bound that the observer in the firmware guarantees, whatever the host sends
  EXPECT_LE(error.most_energy, static_cast<double>(vibe_firmware::AxisConfig().energy_capacity));
  return error;
}

TEST(HapticLoop, RendersAWallThatIsPressedLikeAThousandStepsPerSecond) {
  const Scene scene = loadScene("closed_loop/ball.yaml");
  const HapticLoopSettings settings = settingsOf("closed_loop/press_ball.yaml", 2.1);
  const RenderingError spring = run(scene, settings, Rendering::Spring), held = run(scene, settings, Rendering::Held);
  EXPECT_GT(spring.change, 0.05);
  EXPECT_LT(spring.rendered, 0.06 * spring.change);
  EXPECT_LT(spring.rendered, held.rendered / 4);
  EXPECT_LT(std::abs(spring.delay), 6e-3);
  EXPECT_GT(held.delay, 25e-3);
  // a wall takes energy; a force that comes late gives some
  EXPECT_LT(spring.motor_energy, 0);
  EXPECT_LT(spring.most_energy, 1e-5);
  EXPECT_GT(held.motor_energy, 5e-5);
}

/// The default stomach: minutes.
void checkStomach(const char* script, double from) {
  if (std::getenv("VIBE_SLOW_TESTS") == nullptr) GTEST_SKIP() << "takes minutes; scripts/test --slow runs it";
  const Scene scene = loadScene(resolveAddress("package://vibe_core/scenes/stomach.yaml"));
  const HapticLoopSettings settings = settingsOf(script, from);
  const RenderingError spring = run(scene, settings, Rendering::Spring), held = run(scene, settings, Rendering::Held);
  EXPECT_LT(spring.rendered, held.rendered / 3);
  EXPECT_LT(std::abs(spring.delay), 12e-3);
  EXPECT_GT(held.delay, 25e-3);
  EXPECT_LT(spring.motor_energy, held.motor_energy);
}

TEST(HapticLoop, RendersTheStomachThatIsPressed) {
  checkStomach("../config/hands/press.yaml", 8.9);
}

TEST(HapticLoop, RendersTheStomachThatTheHelixPulls) {
  checkStomach("../config/hands/pull.yaml", 20.4);
}

TEST(HapticLoop, EqualRunsAreEqual) {
  const Scene scene = loadScene("closed_loop/ball.yaml");
  HapticLoopSettings settings = settingsOf("closed_loop/press_ball.yaml", 10);  // without reference
  settings.duration = 2;
  const HapticLoopResult a = runHapticLoop(scene, settings), b = runHapticLoop(scene, settings);
  ASSERT_EQ(a.samples.size(), b.samples.size());
  for (std::size_t i = 0; i < a.samples.size(); ++i) {
    ASSERT_EQ(a.samples[i].insertion, b.samples[i].insertion);
    ASSERT_EQ(a.samples[i].rendered, b.samples[i].rendered);
  }
  EXPECT_LT(a.samples.back().rendered, -0.05);
}

TEST(RenderingError, FindsErrorDelayAndEnergy) {
  std::vector<HapticLoopSample> samples;
  const double w = 2 * M_PI, delay = 7.3e-3;
  double motor = 0, last = 0;
  for (int i = 0; i < 3000; ++i) {
    const double t = kTick * i;
    HapticLoopSample s;
    s.insertion = 0.01 * std::sin(w * t);
    const double middle = t - kTick / 2;  // forces are means over the step
    s.reference = -std::sin(w * middle);  // a spring
    s.rendered = -std::sin(w * (middle - delay));
    motor += s.rendered * (s.insertion - last);
    last = s.insertion;
    s.motor = motor;
    s.measured = true;
    samples.push_back(s);
  }
  const RenderingError error = renderingError(samples);
  EXPECT_NEAR(error.delay, delay, 0.1e-3);
  EXPECT_NEAR(error.change, std::sqrt(0.5), 1e-6);
  EXPECT_NEAR(error.rendered, 2 * std::sin(w * delay / 2) * std::sqrt(0.5), 1e-4);
  // per turn, a late spring gives pi times amplitude of the force, of the motion and the sine of the phase
  EXPECT_NEAR(error.motor_energy, 3 * M_PI * 0.01 * std::sin(w * delay), 2e-5);
  EXPECT_NEAR(error.tissue_energy, 0, 5e-5);
}

}  // namespace
}  // namespace vibe::hardware::haptic_loop_test
