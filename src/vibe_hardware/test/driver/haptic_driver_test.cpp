#include "vibe_hardware/driver/haptic_driver.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "driver/fake_devices.hpp"
#include "vibe_firmware/core/passivity.hpp"

namespace vibe::hardware::haptic_driver_test {
namespace {

class HapticDriverTest : public testing::Test {
 protected:
  FakeDevice device{DeviceKind::Haptic, "H1"};
  FakeBus bus;
  Sentences said;
  std::vector<DeviceSample> samples;
  HapticDriver driver{bus,
                      {vibe_firmware::kVendorId, vibe_firmware::kHapticProductId, ""},
                      [this] { return bus.now; },
                      {[this](const DeviceSample& sample) { samples.push_back(sample); },
                       [](const DeviceConnection&) {}, [](double) {}, said.sink()}};

  void SetUp() override { bus.devices = {&device}; }

  static HapticDriver::Targets spring(double stiffness, double damping = 0, double position = 0) {
    HapticDriver::Targets targets{};
    targets[0] = {position, 0, stiffness, damping, 0};
    return targets;
  }

  /// Runs with a new target each 1/60 s, as the simulator sends them.
  void runTouching(double seconds, const HapticDriver::Targets& targets) {
    double next = bus.now;
    for (const double end = bus.now + seconds; bus.now < end;) {
      if (bus.now >= next) {
        driver.setTarget(targets);
        next += 1.0 / 60;
      }
      step();
    }
  }
  void run(double seconds) {
    for (const double end = bus.now + seconds; bus.now < end;) step();
  }
  void step() {
    driver.poll(0.004);
    if (driver.device().connection() == nullptr) bus.advance(0.005);
  }

  const vibe_firmware::HapticState& state() { return device.haptic().state(); }
  std::uint32_t accepted() { return state().parameters.number; }
};

TEST_F(HapticDriverTest, ThePresentSpringReachesTheDevice) {
  runTouching(0.5, spring(0.1, 1e-3, 0.2));
  EXPECT_FLOAT_EQ(state().parameters.axes[0].stiffness, 0.1F);
  EXPECT_FLOAT_EQ(state().parameters.axes[0].damping, 1e-3F);
  EXPECT_FLOAT_EQ(state().parameters.axes[0].position, 0.2F);
  EXPECT_GT(state().axes[0].torque, 0.015F);  // towards 0.2 rad
  EXPECT_TRUE(driver.statistics().in_force);
  EXPECT_GT(samples.back().torque[0], 0.015);
}

TEST_F(HapticDriverTest, SendsAHundredTimesPerSecondAtMost) {
  double next = bus.now;
  run(0.5);
  const std::uint64_t before = driver.statistics().sent;
  for (const double end = bus.now + 2; bus.now < end;) {
    if (bus.now >= next) driver.setTarget(spring(0.1, 0, 1e-3 * bus.now));
    next += 1e-3;
    step();
  }
  EXPECT_LE(driver.statistics().sent - before, 201U);
  EXPECT_GE(driver.statistics().sent - before, 130U);
}

TEST_F(HapticDriverTest, AnIdleHostKeepsTheWatchdogOfTheDeviceQuiet) {
  run(0.3);
  samples.clear();
  run(5);
  for (const DeviceSample& sample : samples) ASSERT_EQ(sample.flags & vibe_firmware::kHostSilent, 0);
  EXPECT_GE(driver.statistics().sent, 100U);
  EXPECT_LE(driver.statistics().sent, 140U);
}

TEST_F(HapticDriverTest, WithoutNewsFromTheSimulatorTheSpringFades) {
  runTouching(0.5, spring(0.1, 0, 0.2));
  run(0.09);
  EXPECT_FLOAT_EQ(state().parameters.axes[0].stiffness, 0.1F);
  run(0.035);
  EXPECT_LT(state().parameters.axes[0].stiffness, 0.08F);
  EXPECT_GT(state().parameters.axes[0].stiffness, 0.01F);
  run(0.065);
  EXPECT_EQ(state().parameters.axes[0].stiffness, 0);
  EXPECT_NEAR(state().axes[0].torque, 0, 1e-6);
}

TEST_F(HapticDriverTest, TheEndOfAContactFadesTheSpring) {
  runTouching(0.5, spring(0.1, 0, 0.2));
  driver.release();
  run(0.02);
  EXPECT_LT(state().parameters.axes[0].stiffness, 0.09F);
  run(0.06);
  EXPECT_EQ(state().parameters.axes[0].stiffness, 0);
}

TEST_F(HapticDriverTest, ForAPauseAfterAReleaseNoTargetIsTaken) {
  runTouching(0.5, spring(0.1, 0, 0.2));
  driver.release(0.1);
  driver.release();  // does not shorten the pause
  runTouching(0.099, spring(0.1, 0, 0.5));
  EXPECT_EQ(state().parameters.axes[0].stiffness, 0);
  EXPECT_NE(state().parameters.axes[0].position, 0.5F);
  runTouching(0.1, spring(0.1, 0, 0.5));
  EXPECT_FLOAT_EQ(state().parameters.axes[0].stiffness, 0.1F);
  EXPECT_FLOAT_EQ(state().parameters.axes[0].position, 0.5F);
}

TEST_F(HapticDriverTest, ClampsToWhatIsPassiveAndTheDeviceAccepts) {
  runTouching(0.5, spring(100, 1, 0));
  const vibe_firmware::AxisConfig axis;
  const float largest = vibe_firmware::maxStiffness(axis, 0);
  EXPECT_NEAR(state().parameters.axes[0].stiffness, largest, 1e-3F * largest);
  EXPECT_GT(driver.statistics().clamped, 20U);
  EXPECT_EQ(driver.statistics().refused, 0U);
  EXPECT_EQ(said.count("refused"), 0);
}

TEST_F(HapticDriverTest, NoTargetWhateverItIsIsEverRefused) {
  run(0.3);
  std::mt19937 random(1);
  std::uniform_real_distribution<double> exponent(-6, 6), sign(-1, 1);
  const auto any = [&] { return std::pow(10, exponent(random)); };
  for (int i = 0; i < 2000; ++i) {
    HapticDriver::Targets targets{};
    for (JointSpring& t : targets) t = {sign(random) * any(), sign(random) * any(), any(), any(), sign(random) * any()};
    driver.setTarget(targets);
    bus.advance(0.01);
    step();
  }
  EXPECT_GT(driver.statistics().sent, 1900U);
  EXPECT_EQ(driver.statistics().refused, 0U);
  EXPECT_EQ(driver.statistics().last_refusal, "");
}

TEST_F(HapticDriverTest, ARefusalIsReportedWithItsReason) {
  // a device that is weaker than it says
  device.tamper_feature = [](std::uint8_t id, Packet& packet) {
    if ((id & 0xFE) != vibe_firmware::kAxisReportId) return;
    vibe_firmware::AxisReport report;
    vibe_firmware::unpack(packet.data(), packet.size(), report);
    report.config.viscous_friction *= 10;
    report.config.coulomb_friction *= 10;
    std::uint8_t bytes[vibe_firmware::kAxisReportSize];
    vibe_firmware::pack(report, bytes);
    packet.assign(bytes, bytes + sizeof bytes);
  };
  runTouching(0.5, spring(3, 0, 0));
  EXPECT_GE(driver.statistics().refused, 1U);
  EXPECT_EQ(said.count("refused parameter set"), 1);
  EXPECT_EQ(said.count("axis 0: stiffness and damping would need a viscous friction of"), 1);
  EXPECT_EQ(state().parameters.axes[0].stiffness, 0);
  EXPECT_FALSE(driver.statistics().in_force);
}

TEST_F(HapticDriverTest, ParametersThatAreNotAnsweredAreNoFaultOfTheirForm) {
  run(0.3);
  device.request = [] { throw NoAnswer("Connection timed out"); };
  runTouching(0.5, spring(0.1));
  EXPECT_EQ(said.count("does not take parameters. It does not answer the parameters in time"), 1);
  EXPECT_EQ(said.count("rejects the form"), 0);
}

TEST_F(HapticDriverTest, AfterAReplugTheParametersAreSentAgainAndReadBack) {
  runTouching(1, spring(0.1, 0, 0.2));
  device.plugged = false;
  runTouching(1, spring(0.1, 0, 0.2));
  device.start();
  device.plugged = true;
  const double plugged = bus.now;
  int reads = 0;
  device.tamper_feature = [&reads](std::uint8_t id, Packet&) { reads += id == vibe_firmware::kParameterReportId; };
  while (accepted() == 0 && bus.now < plugged + 2) runTouching(0.01, spring(0.1, 0, 0.2));
  EXPECT_LT(bus.now - plugged, 0.3);
  runTouching(0.2, spring(0.1, 0, 0.2));
  EXPECT_FLOAT_EQ(state().parameters.axes[0].stiffness, 0.1F);
  EXPECT_GE(reads, 1);
  EXPECT_EQ(driver.statistics().mismatched, 0U);
}

TEST_F(HapticDriverTest, AWeakerDeviceDoesNotGetTheSpringOfTheOneBefore) {
  runTouching(1, spring(0.1, 0, 0.2));
  device.plugged = false;
  run(1);
  for (vibe_firmware::AxisConfig& axis : device.haptic_config.axes) axis.torque_limit *= 0.5F;
  device.start();
  device.plugged = true;
  samples.clear();
  run(2);
  EXPECT_NE(accepted(), 0U);
  EXPECT_EQ(driver.statistics().refused, 0U);
  EXPECT_EQ(said.count("refused"), 0);
  EXPECT_TRUE(driver.statistics().in_force);
  EXPECT_EQ(samples.back().flags & vibe_firmware::kHostSilent, 0);
  runTouching(0.2, spring(0.1, 0, 0.2));
  EXPECT_FLOAT_EQ(state().parameters.axes[0].stiffness, 0.1F);
}

TEST_F(HapticDriverTest, ParametersThatReadBackDifferentlyAreReported) {
  device.tamper_feature = [](std::uint8_t id, Packet& packet) {
    if (id == vibe_firmware::kParameterReportId) packet[6] ^= 1;  // a bit of the stiffness of axis 0
  };
  runTouching(2, spring(0.1, 0, 0.2));
  EXPECT_GE(driver.statistics().mismatched, 1U);
  EXPECT_EQ(said.count("does not hold the parameters that were sent: stiffness of axis 0 is"), 1);
}

TEST_F(HapticDriverTest, AHundredSetsReadBackBitByBit) {
  std::mt19937 random(2);
  std::uniform_real_distribution<double> value(0, 0.3);
  run(0.3);
  for (int i = 0; i < 100; ++i) {
    const HapticDriver::Targets targets = spring(value(random), 1e-3 * value(random), value(random));
    driver.setTarget(targets);
    run(0.02);
    const vibe_firmware::ParameterReport read = driver.device().connection()->readParameters();
    EXPECT_FLOAT_EQ(read.axes[0].stiffness, static_cast<float>(targets[0].stiffness));
    EXPECT_FLOAT_EQ(read.axes[0].damping, static_cast<float>(targets[0].damping));
    EXPECT_FLOAT_EQ(read.axes[0].position, static_cast<float>(targets[0].position));
  }
}

TEST_F(HapticDriverTest, ADeviceThatIsOpenedAgainGetsParametersAtOnce) {
  run(1);
  for (const std::uint64_t sent = driver.statistics().sent; driver.statistics().sent == sent;) step();
  const double last_sent = bus.now;
  device.plugged = false;
  step();
  device.start();
  device.plugged = true;
  while (driver.device().connection() == nullptr) step();
  run(0.01);
  ASSERT_LT(bus.now - last_sent, HapticLink::kHeartbeat) << "a heartbeat was due anyway";
  EXPECT_NE(accepted(), 0U);
}

TEST_F(HapticDriverTest, NothingIsAskedOfADeviceWhoseReportsAreLate) {
  runTouching(0.5, spring(0.1));
  device.stopped = true;
  runTouching(0.07, spring(0.1));
  const std::uint64_t sent = driver.statistics().sent;
  runTouching(0.1, spring(0.1));
  EXPECT_EQ(driver.device().state(), LinkState::Running) << "not silent yet";
  EXPECT_EQ(driver.statistics().sent, sent);
}

TEST_F(HapticDriverTest, ADeviceThatStopsIsNotSpokenTo) {
  runTouching(0.5, spring(0.1));
  device.stopped = true;
  runTouching(0.5, spring(0.1));
  const std::uint64_t sent = driver.statistics().sent;
  runTouching(0.5, spring(0.1));
  EXPECT_EQ(driver.statistics().sent, sent);
  EXPECT_NEAR(state().axes[0].torque, 0, 1e-9);  // its watchdog has acted
  EXPECT_FALSE(driver.statistics().in_force);
}

}  // namespace
}  // namespace vibe::hardware::haptic_driver_test
