// The firmware in emulated devices: what a host reads, and what a hand feels.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <thread>

#include "emulator/served_device.hpp"
#include "vibe_firmware/core/passivity.hpp"
#include "vibe_hardware/emulator/emulator.hpp"
#include "vibe_hardware/emulator/usb_host.hpp"
#include "vibe_hardware/hid/socket_bus.hpp"

namespace vibe::hardware::emulated_device_test {
namespace {

using vibe_firmware::InputReport;
using vibe_firmware::ParameterReport;

EmulatorSetup makeSetup() {
  EmulatorSetup setup;
  setup.calibration = Calibration::load("../config/devices.yaml");
  return setup;
}

EmulatedHaptic makeHaptic(const EmulatorSetup& setup = makeSetup()) {
  return EmulatedHaptic(setup.haptic, plantsOf(setup), "T-1");
}

/// Sends parameters of axis 0; the other axis is free.
bool send(UsbHost& host, const vibe_firmware::AxisParameters& axis, std::uint16_t number = 1) {
  ParameterReport report;
  report.number = number;
  report.axes[0] = axis;
  std::uint8_t bytes[vibe_firmware::kParameterReportSize];
  pack(report, bytes);
  return host.setFeature(bytes, sizeof bytes);
}

vibe_firmware::StatusReport statusOf(UsbHost& host) {
  vibe_firmware::StatusReport status;
  const std::vector<std::uint8_t> bytes = host.getFeature(vibe_firmware::kStatusReportId);
  EXPECT_TRUE(unpack(bytes.data(), bytes.size(), status));
  return status;
}

/// Holds axis 0 at a place for some time, with parameters every 50 ms.
void hold(EmulatedHaptic& device, UsbHost& host, const vibe_firmware::AxisParameters& spring, double intended,
          int milliseconds) {
  for (int i = 0; i < milliseconds; ++i) {
    if (i % 50 == 0) send(host, spring);
    DeviceMotion motion;
    motion.intended[0] = intended;
    device.tick(motion);
  }
}

TEST(EmulatedHaptic, AHeldSpringIsFeltWithItsStiffness) {
  EmulatedHaptic device = makeHaptic();
  UsbHost host(device.function());
  const double stiffness = 0.3;
  const vibe_firmware::AxisParameters spring{0.3F, 0, 0, 0, 0.029F};
  const double step = device.plant(0).encoder_step, friction = coulombFriction(device.plant(0));
  double worst = 0;
  std::vector<std::array<double, 2>> held;  // position, torque of the hand
  for (const double intended : {0.0, 0.1, 0.2, 0.3, 0.4, 0.5, 0.4, 0.3, 0.2, 0.1, 0.0}) {
    hold(device, host, spring, intended, 1000);
    const AxisPlantState& axis = device.axis(0);
    ASSERT_EQ(axis.velocity, 0);
    worst = std::max(worst, std::abs(static_cast<double>(device.torques()[0]) + stiffness * axis.position));
    const double hand = device.plant(0).hand.stiffness * (intended - axis.position);
    EXPECT_LT(std::abs(hand - stiffness * axis.position), friction + stiffness * step);
    held.push_back({axis.position, hand});
  }
  EXPECT_GT(held[5][0], 0.06);
  EXPECT_LE(worst, stiffness * step + 1e-7);
  // on the way in and on the way back friction has the opposite sign
  const double slope =
      (held[4][1] + held[6][1] - held[2][1] - held[8][1]) / (held[4][0] + held[6][0] - held[2][0] - held[8][0]);
  EXPECT_NEAR(slope, stiffness, 0.02 * stiffness);
  std::printf("static error of the torque %.1f uN m of %.0f uN m; stiffness felt %.4f instead of %.4f N m/rad\n",
              1e6 * worst, 1e6 * stiffness * held[5][0], slope, stiffness);
}

TEST(EmulatedHaptic, WithoutAHostTheSpringFades) {
  EmulatedHaptic device = makeHaptic();
  UsbHost host(device.function());
  const vibe_firmware::AxisParameters spring{0.3F, 0, 0, 0, 0.029F};
  hold(device, host, spring, 0.5, 1000);
  EXPECT_LT(device.torques()[0], -0.015F);
  DeviceMotion motion;
  motion.intended[0] = 0.5;
  for (int i = 0; i < 400; ++i) device.tick(motion);
  EXPECT_EQ(device.torques()[0], 0);
}

TEST(EmulatedHaptic, RefusesAStiffnessThatIsNotPassiveAndKeepsTheOldOne) {
  EmulatedHaptic device = makeHaptic();
  UsbHost host(device.function());
  const float limit = vibe_firmware::maxStiffness(device.firmware().config().axes[0], 0);
  EXPECT_TRUE(send(host, {0.99F * limit, 0, 0, 0, 0.029F}, 7));
  device.tick({});
  EXPECT_TRUE(send(host, {1.01F * limit, 0, 0, 0, 0.029F}, 8));
  device.tick({});
  const vibe_firmware::StatusReport status = statusOf(host);
  EXPECT_EQ(status.parameter_number, 7);
  EXPECT_EQ(status.refused_number, 8);
  EXPECT_EQ(status.refusal.refusal, vibe_firmware::Refusal::ViscousFriction);
  EXPECT_FALSE(host.setFeature(reinterpret_cast<const std::uint8_t*>("\2abc"), 4));  // malformed: stall
  EXPECT_TRUE(host.getFeature(77).empty());
}

/// All reports of a device while it is moved.
std::vector<InputReport> record(EmulatedDevice& device, int ticks, const std::function<DeviceMotion(int)>& motion) {
  std::vector<InputReport> reports;
  for (int i = 0; i < ticks; ++i) {
    device.tick(motion(i));
    std::uint8_t bytes[vibe_firmware::kInputReportSize];
    if (!device.nextReport(bytes)) continue;
    InputReport report;
    EXPECT_TRUE(unpack(bytes, sizeof bytes, report));
    reports.push_back(report);
  }
  return reports;
}

void expectRegular(const std::vector<InputReport>& reports) {
  for (std::size_t i = 1; i < reports.size(); ++i) {
    ASSERT_EQ(static_cast<std::uint16_t>(reports[i].sequence - reports[i - 1].sequence), 1);
    ASSERT_EQ(reports[i].time_us - reports[i - 1].time_us, 10000U);
  }
}

TEST(EmulatedHaptic, ReportsEvery10MillisecondsThroughTheWrapOfTheCounter) {
  EmulatedHaptic device = makeHaptic();
  const auto there_and_back = [](int i) {
    DeviceMotion motion;
    motion.intended = {15 - 15 * std::cos(M_PI * i / 4000), -15 + 15 * std::cos(M_PI * i / 4000)};
    return motion;
  };
  const std::vector<InputReport> reports = record(device, 8000, there_and_back);
  ASSERT_EQ(reports.size(), 800U);
  expectRegular(reports);
  std::int32_t most = 0;
  for (const InputReport& report : reports) {
    EXPECT_EQ(report.flags & vibe_firmware::kEncoderFault, 0);
    most = std::max(most, report.counts[0]);
  }
  EXPECT_NEAR(most, 30 / device.plant(0).encoder_step, 60);  // 97,700: beyond 16 bits; friction may hold it
  EXPECT_NE(reports.back().flags & vibe_firmware::kIndexed0, 0);
  EXPECT_LT(std::abs(reports.back().counts[0]), 60);
  EXPECT_LT(std::abs(reports.back().counts[1]), 60);
}

TEST(EmulatedHaptic, AnEncoderThatCountsBackwardsIsConfiguredByTheSign) {
  EmulatorSetup setup = makeSetup();
  for (auto& axis : setup.haptic.axes) axis.radians_per_count *= -1;
  EmulatedHaptic device = makeHaptic(setup);
  UsbHost host(device.function());
  hold(device, host, {0.3F, 0, 0, 0, 0.029F}, 0.3, 1000);
  EXPECT_NEAR(device.torques()[0], -0.3 * device.axis(0).position, 0.3 * 2 * device.plant(0).encoder_step);
  EXPECT_GT(device.axis(0).position, 0.03);
  EXPECT_GT(device.firmware().state().axes[0].position, 0.03F);
}

TEST(EmulatedHaptic, ARestartCountsFromWhereItIs) {
  EmulatedHaptic device = makeHaptic();
  DeviceMotion motion;
  motion.intended[0] = 2;
  std::vector<InputReport> reports = record(device, 500, [&](int) { return motion; });
  EXPECT_NEAR(reports.back().counts[0], 2 / device.plant(0).encoder_step, 60);
  device.restart();
  reports = record(device, 500, [&](int) { return motion; });
  EXPECT_LT(std::abs(reports.back().counts[0]), 3);
  EXPECT_LT(reports.front().sequence, 2);
}

TEST(EmulatedInput, ReportsWheelsAndButtons) {
  EmulatedInput device(vibe_firmware::InputConfig(), "T-2");
  const double step = static_cast<double>(vibe_firmware::AxisConfig().radians_per_count);
  const auto motion = [](int i) {
    DeviceMotion at;
    at.intended = {1e-3 * i, -2e-3 * i};
    at.buttons = i < 500 ? 5 : 2;
    return at;
  };
  const std::vector<InputReport> reports = record(device, 1000, motion);
  ASSERT_EQ(reports.size(), 100U);
  expectRegular(reports);
  for (const InputReport& report : reports) {
    const double tick = 1e-6 * report.time_us / kTick;
    ASSERT_NEAR(report.counts[0] * step, 1e-3 * tick, 2 * step);
    ASSERT_NEAR(report.counts[1] * step, -2e-3 * tick, 2 * step);
    if ((tick > 20 && tick < 500) || tick > 520) {
      ASSERT_EQ(report.buttons, tick < 500 ? 5 : 2);
    }
  }
}

/// A hand that stays somewhere.
class StillHand : public Hand {
 public:
  HandSample at(double) const override {
    HandSample sample;
    sample.joints = {0.1, 0.5, -0.3, 0.2};
    sample.buttons[Needle] = 1;
    return sample;
  }
  double duration() const override { return 1; }
};

TEST(Emulator, TheHandFirstGoesToWhereItBegins) {
  Emulator emulator(makeSetup(), std::make_shared<StillHand>());
  EXPECT_LT(emulator.handTime(), 0);
  double fastest = 0, last = 0;
  while (emulator.handTime() < 0) {
    emulator.tick();
    const double position = emulator.haptic().axis(0).position;
    fastest = std::max(fastest, std::abs(position - last) / kTick);
    last = position;
  }
  EXPECT_NEAR(last, 10, 0.1);  // 0.1 m over a roller of 10 mm
  EXPECT_LT(fastest, 12);
  EXPECT_FALSE(emulator.finished());
  emulator.tick(1100);
  EXPECT_TRUE(emulator.finished());
}

TEST(Emulator, EqualRunsGiveEqualReports) {
  const auto reports = [] {
    Emulator emulator(makeSetup(), std::make_shared<StillHand>());
    std::vector<std::uint8_t> all;
    for (int i = 0; i < 3000; ++i) {
      emulator.tick();
      std::uint8_t bytes[vibe_firmware::kInputReportSize];
      for (EmulatedDevice* device :
           {static_cast<EmulatedDevice*>(&emulator.haptic()), static_cast<EmulatedDevice*>(&emulator.input())})
        if (device->nextReport(bytes)) all.insert(all.end(), std::begin(bytes), std::end(bytes));
    }
    return all;
  };
  const std::vector<std::uint8_t> first = reports();
  EXPECT_EQ(first.size(), 2 * 300 * vibe_firmware::kInputReportSize);
  EXPECT_EQ(first, reports());
}

// A host behind a socket: reads every report, writes parameters and reads them back.
TEST(Emulator, AHostBehindASocketDrivesTheFirmware) {
  test::SocketFolder folder;
  EmulatedHaptic device = makeHaptic();
  test::ServedDevice served(folder.path(), "haptic", device.function());
  SocketBus bus(folder.path());
  const auto port = bus.open(bus.list().at(0).path);
  int last = -1;
  for (int i = 0; i < 100; ++i) {
    ParameterReport parameters;
    parameters.number = static_cast<std::uint16_t>(i + 1);
    parameters.axes[0] = {0.001F * static_cast<float>(i), 0, 0, 0, 0.029F};
    std::uint8_t bytes[vibe_firmware::kParameterReportSize], sent[vibe_firmware::kInputReportSize], read[64];
    pack(parameters, bytes);
    port->setFeature(bytes, sizeof bytes);
    served.with([&](SocketServer& server) {
      for (int tick = 0; tick < 10; ++tick) {
        device.tick({});
        if (device.nextReport(sent)) server.publish(sent, sizeof sent);
      }
    });
    ASSERT_EQ(port->getFeature(vibe_firmware::kParameterReportId, read, sizeof read), sizeof bytes);
    EXPECT_TRUE(std::equal(std::begin(bytes), std::end(bytes), read));
    ASSERT_EQ(port->read(read, sizeof read, 1), vibe_firmware::kInputReportSize);
    InputReport report;
    ASSERT_TRUE(unpack(read, vibe_firmware::kInputReportSize, report));
    ASSERT_EQ(report.sequence, ++last);
  }
}

}  // namespace
}  // namespace vibe::hardware::emulated_device_test
