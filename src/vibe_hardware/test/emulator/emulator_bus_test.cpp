// Drivers of the host on emulated devices in the same program, in virtual time.
#include "vibe_hardware/emulator/emulator_bus.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "emulator/loop_host.hpp"
#include "vibe_core/trainee/trainee_script.hpp"
#include "vibe_firmware/protocol/descriptors.hpp"
#include "vibe_hardware/emulator/hand.hpp"
#include "vibe_hardware/hid/socket_bus.hpp"

namespace vibe::hardware::emulator_bus_test {
namespace {

constexpr const char* kScript = R"(
name: all joints
actions:
  - together:
      - {move: {insertion: 0.1, rotation: 1, tip_up_down: 0.5, tip_left_right: -0.4}, in: 2}
      - {move: {helix_advance: 0.02, helix_rotation: 3 turns, needle_driver: 0.018}, in: 4}
  - {press: helix_grab}
  - {wait: 0.5}
  - {move: {helix_advance: 0.005, helix_rotation: 0, needle_driver: 0}, in: 4}
  - {wait: 0.5}
)";

struct Bench {
  Bench() : emulator(setup(), std::make_shared<ScriptedHand>(script)) {}

  static EmulatorSetup setup() {
    EmulatorSetup setup;
    setup.calibration = Calibration::load("../config/devices.yaml");
    return setup;
  }

  TraineeScript script = TraineeScript::parse(kScript, "test");
  Emulator emulator;
  EmulatorBus bus{emulator};
};

TEST(EmulatorBus, ListsBothDevices) {
  Bench bench;
  const std::vector<HidInfo> found = bench.bus.list();
  ASSERT_EQ(found.size(), 2U);
  EXPECT_EQ(found[0].product, vibe_firmware::kHapticProductId);
  EXPECT_EQ(found[1].product, vibe_firmware::kInputProductId);
  EXPECT_EQ(found[0].serial, "EMULATOR");
  EXPECT_THROW(bench.bus.open("none"), DeviceGone);
  Packet report(64);
  const auto port = bench.bus.open(found[0].path);
  EXPECT_THROW(port->getFeature(99, report.data(), report.size()), ReportRejected);
  EXPECT_EQ(port->read(report.data(), report.size(), 1), 0U);
}

// What the drivers tell the simulator is what the script says. A report is up to 10 ms old, friction bends the hand,
// and buttons of the suturing device make steps.
TEST(EmulatorBus, TheSimulatorIsToldWhatTheScriptSays) {
  Bench bench;
  const Calibration calibration = Bench::setup().calibration;
  LoopHost host(bench.bus, calibration, [&] { return bench.emulator.time(); });
  const double limits[kJointCount] = {4e-3, 0.04, 4e-3, 4e-3, 0.3e-3, 0.3, 0.5e-3};
  double moved = 0;
  while (!bench.emulator.finished()) {
    bench.emulator.tick();
    bench.bus.collect();
    host.poll();
    const double time = bench.emulator.time();
    if (time < 0.5) continue;
    const StepInput told = host.inputAt(time), said = bench.script.at(time - 0.005);
    for (int joint = 0; joint < kJointCount; ++joint)
      ASSERT_NEAR(told.joints[joint], said.joints[joint], limits[joint]) << kJointNames[joint] << " at " << time;
    ASSERT_TRUE(time < 4.1 || told.buttons[HelixGrab] == 1);
    moved = std::max(moved, told.joints[HelixRotation]);
  }
  EXPECT_NEAR(moved, 6 * M_PI, 0.2);
  EXPECT_EQ(host.statistics().refused, 0U);
}

TEST(SuturingDeviceFingers, FollowNoFasterThanTheHost) {
  const Calibration calibration = Bench::setup().calibration;
  SuturingDeviceFingers fingers(*calibration.suturing_device);
  const auto& helix = (*calibration.suturing_device)[0];
  int steps = 0;
  while (std::abs(fingers.positions()[0] - 0.01) > 1e-5 && steps < 1000) {
    fingers.decide({0.01, 0, 0}, 0.01);
    ++steps;
    EXPECT_TRUE(fingers.isPressed(helix.forward));
    EXPECT_FALSE(fingers.isPressed(helix.backward));
  }
  EXPECT_EQ(steps, std::lround(0.01 / (helix.speed * 0.01)));
  fingers.decide({0.01, 0, 0}, 0.01);
  EXPECT_FALSE(fingers.isPressed(helix.forward));
  for (int i = 0; i < 1000; ++i) fingers.decide({-1, 0, 0}, 0.01);  // beyond the limit of the joint
  EXPECT_NEAR(fingers.positions()[0], helix.lower, 1e-12);
  EXPECT_FALSE(fingers.isPressed(helix.backward));
}

}  // namespace
}  // namespace vibe::hardware::emulator_bus_test
