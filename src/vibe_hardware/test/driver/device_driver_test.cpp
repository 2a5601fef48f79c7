#include "vibe_hardware/driver/device_driver.hpp"

#include <gtest/gtest.h>

#include "driver/fake_devices.hpp"

namespace vibe::hardware::device_driver_test {
namespace {

constexpr double kWait = 0.004;

class DeviceDriverTest : public testing::Test {
 protected:
  FakeDevice device{DeviceKind::Input, "A1"};
  FakeBus bus;
  Sentences said;
  std::vector<DeviceSample> samples;
  int lost = 0, connected = 0;
  DeviceDriver driver{bus, DeviceKind::Input, selection(), [this] { return bus.now; }, callbacks()};

  void SetUp() override { bus.devices = {&device}; }

  static DeviceSelection selection() { return {vibe_firmware::kVendorId, vibe_firmware::kInputProductId, ""}; }

  DeviceDriver::Callbacks callbacks() {
    return {[this](const DeviceSample& sample) { samples.push_back(sample); },
            [this](const DeviceConnection&) { ++connected; }, [this](double) { ++lost; }, said.sink()};
  }

  void run(double seconds) {
    for (const double end = bus.now + seconds; bus.now < end;) {
      driver.poll(kWait);
      if (driver.connection() == nullptr) bus.advance(0.005);
    }
  }

  StreamCounts counts() const { return driver.statistics().counts; }
};

TEST_F(DeviceDriverTest, ReadsSamplesInTheUnitsOfTheAxes) {
  device.sample.counter = {100, 0};
  run(0.5);
  device.sample.counter = {90, 20};  // the firmware counts from its first sample
  device.sample.buttons = 5;
  run(0.5);
  ASSERT_GT(samples.size(), 90U);
  const vibe_firmware::AxisConfig axis;
  EXPECT_NEAR(samples.back().position[0], -10 * axis.radians_per_count, 1e-9);
  EXPECT_NEAR(samples.back().position[1], 20 * axis.radians_per_count, 1e-9);
  EXPECT_EQ(samples.back().buttons, 5);
  EXPECT_TRUE(samples.front().restarted);
  EXPECT_FALSE(samples.back().restarted);
  EXPECT_NEAR(driver.statistics().rate, 100, 3);
  EXPECT_EQ(counts().lost, 0U);
  EXPECT_EQ(driver.state(), LinkState::Running);
}

TEST_F(DeviceDriverTest, WaitsQuietlyForADeviceThatIsNotThere) {
  device.plugged = false;
  run(30);
  EXPECT_EQ(said.all.size(), 1U);
  EXPECT_EQ(said.count("There is no input device with id 1209:0002; plug it in"), 1);
  EXPECT_EQ(driver.statistics().state, LinkState::Absent);
  EXPECT_LE(bus.lists, 31 / DeviceDriver::kSearchPeriod);
  device.plugged = true;
  run(0.5);
  EXPECT_EQ(driver.state(), LinkState::Running);
}

TEST_F(DeviceDriverTest, ABusThatDoesNotWorkIsReportedOnce) {
  bus.error = "The kernel has no hidraw.";
  run(30);
  EXPECT_EQ(said.all, std::vector<std::string>{bus.error});
  bus.error.clear();
  run(0.5);
  EXPECT_EQ(driver.state(), LinkState::Running);
}

TEST_F(DeviceDriverTest, ADeviceThatMayNotBeOpenedIsReportedOnceAndUsedWhenItMay) {
  device.open_error = "This user may not open it: install the udev rule.";
  run(10);
  EXPECT_EQ(said.all.size(), 1U);
  EXPECT_EQ(said.count("/fake/A1, serial number A1 cannot be used. This user may not open it"), 1);
  EXPECT_EQ(driver.statistics().state, LinkState::Unusable);
  device.open_error.clear();
  run(0.5);
  EXPECT_EQ(driver.state(), LinkState::Running);
}

TEST_F(DeviceDriverTest, ADeviceThatIsListedButNeverOpensIsReportedOnceAndUsedWhenItOpens) {
  device.gone = 1000;
  run(10);
  EXPECT_EQ(said.all.size(), 1U);
  EXPECT_EQ(said.count("The input device at /fake/A1, serial number A1 is there, but opening it fails again and again "
                       "(/fake/A1: Device or resource busy); another program may use it: end that, or check the cable"),
            1);
  EXPECT_EQ(driver.statistics().state, LinkState::Unusable);
  EXPECT_NE(driver.statistics().problem, "");
  device.gone = 0;
  run(0.5);
  EXPECT_EQ(driver.state(), LinkState::Running);
  EXPECT_EQ(driver.statistics().problem, "");
}

TEST_F(DeviceDriverTest, ADeviceThatIsGoneWhileItIsOpenedIsNoFault) {
  device.gone = DeviceDriver::kMostFailures - 1;
  run(2);
  EXPECT_EQ(driver.state(), LinkState::Running);
  for (int i = 0; i < 10; ++i) {  // each time it is unplugged it is listed for a moment longer
    device.plugged = false;
    run(0.5);
    device.gone = 1;
    device.plugged = true;
    run(0.5);
  }
  EXPECT_EQ(driver.state(), LinkState::Running);
  EXPECT_EQ(said.count("opening it fails"), 0);
}

TEST_F(DeviceDriverTest, ReconnectsWithinASecond) {
  run(1);
  const std::size_t before = samples.size();
  device.plugged = false;
  run(3);
  EXPECT_EQ(lost, 1);
  EXPECT_EQ(said.count("is gone"), 1);
  EXPECT_EQ(driver.state(), LinkState::Absent);
  EXPECT_LE(samples.size() - before, 1U);
  device.start();
  device.plugged = true;
  const double plugged = bus.now;
  const std::size_t during = samples.size();
  run(1);
  ASSERT_GT(samples.size(), during);
  EXPECT_LT(samples[during].time - plugged, 0.3);
  EXPECT_TRUE(samples[during].restarted);
  EXPECT_EQ(driver.statistics().connections, 2U);
  EXPECT_EQ(connected, 2);
}

TEST_F(DeviceDriverTest, ACableThatWasPulledFromADeviceWithPowerDoesNotRestartItsCounts) {
  device.sample.counter = {0, 0};
  run(2);
  device.plugged = false;
  run(5);
  device.sample.counter = {50, 0};
  device.plugged = true;
  const std::size_t during = samples.size();
  run(1);
  ASSERT_GT(samples.size(), during);
  EXPECT_FALSE(samples[during].restarted);
  EXPECT_NEAR(samples.back().position[0], 50 * vibe_firmware::AxisConfig().radians_per_count, 1e-9);
  EXPECT_EQ(counts().restarts, 0U);
}

TEST_F(DeviceDriverTest, SurvivesAHundredReplugs) {
  for (int i = 0; i < 100; ++i) {
    run(0.3);
    device.plugged = false;
    run(0.05);
    device.start();
    device.plugged = true;
  }
  run(0.5);
  EXPECT_EQ(driver.statistics().connections, 101U);
  EXPECT_EQ(counts().lost, 0U);
  EXPECT_EQ(counts().restarts, 100U);
}

TEST_F(DeviceDriverTest, CountsLostReports) {
  int i = 0;
  device.tamper = [&i](const Packet& packet) { return ++i % 10 == 0 ? Packets{} : Packets{packet}; };
  run(2);
  EXPECT_NEAR(static_cast<double>(counts().lost), 20, 1);
  EXPECT_EQ(counts().duplicated, 0U);
}

TEST_F(DeviceDriverTest, IgnoresReportsThatComeTwice) {
  device.tamper = [](const Packet& packet) { return Packets{packet, packet}; };
  run(2);
  EXPECT_NEAR(static_cast<double>(counts().duplicated), 200, 2);
  EXPECT_NEAR(static_cast<double>(samples.size()), 200, 2);
  EXPECT_EQ(said.count("came a second time"), 1);
  EXPECT_EQ(counts().lost, 0U);
}

TEST_F(DeviceDriverTest, IgnoresReportsThatWereReordered) {
  Packet held;
  int i = 0;
  device.tamper = [&](const Packet& packet) {
    ++i;
    if (i % 10 == 0) {
      held = packet;
      return Packets{};
    }
    if (i % 10 == 1 && !held.empty()) return Packets{packet, held};
    return Packets{packet};
  };
  run(2);
  EXPECT_NEAR(static_cast<double>(counts().reordered), 20, 1);
  EXPECT_EQ(said.count("reordered, sent again, or the device began anew"), 1);
  for (std::size_t k = 1; k < samples.size(); ++k) EXPECT_GT(samples[k].time, samples[k - 1].time);
  EXPECT_EQ(counts().restarts, 0U);
}

TEST_F(DeviceDriverTest, IgnoresAReplayOfOldReports) {
  Packets recorded;
  device.tamper = [&recorded](const Packet& packet) {
    recorded.push_back(packet);
    return Packets{packet};
  };
  run(1);
  device.sample.buttons = 1;
  run(1);
  std::size_t next = 0;
  device.tamper = [&](const Packet& packet) { return Packets{packet, recorded.at(next++)}; };
  const std::size_t before = samples.size();
  run(0.5);
  for (std::size_t k = before; k < samples.size(); ++k) EXPECT_EQ(samples[k].buttons, 1);
  EXPECT_NEAR(static_cast<double>(counts().reordered), 50, 2);
  EXPECT_EQ(counts().restarts, 0U);
}

TEST_F(DeviceDriverTest, AcceptsADeviceThatRestartsWithoutBeingUnplugged) {
  run(2);
  device.start();
  run(1);
  EXPECT_EQ(counts().restarts, 1U);
  EXPECT_EQ(driver.state(), LinkState::Running);
  EXPECT_LT(driver.statistics().age, 0.02);
}

TEST_F(DeviceDriverTest, IgnoresTruncatedAndOverlongReportsWithOneSentence) {
  int i = 0;
  device.tamper = [&i](const Packet& packet) {
    Packet bad = packet;
    bad.resize(++i % 2 == 0 ? 5 : 64);
    return Packets{packet, bad};
  };
  run(2);
  EXPECT_NEAR(static_cast<double>(counts().malformed), 200, 2);
  EXPECT_NEAR(static_cast<double>(samples.size()), 200, 2);
  EXPECT_EQ(said.count("expected are 28 bytes with id 1"), 1);
  run(20);
  EXPECT_LE(said.count("expected are 28 bytes with id 1"), 4);  // one each 10 s
  EXPECT_GE(said.count("more of this kind"), 1);
}

TEST_F(DeviceDriverTest, IgnoresADeviceTimeThatCannotBe) {
  device.tamper = [](const Packet& packet) {
    vibe_firmware::InputReport report;
    vibe_firmware::unpack(packet.data(), packet.size(), report);
    Packet bad = packet;
    if (report.sequence % 10 == 5) {
      report.time_us += 1000000000;
      std::uint8_t bytes[vibe_firmware::kInputReportSize];
      vibe_firmware::pack(report, bytes);
      bad.assign(bytes, bytes + sizeof bytes);
    }
    return Packets{bad};
  };
  run(2);
  EXPECT_NEAR(static_cast<double>(counts().implausible), 20, 1);
  for (const DeviceSample& sample : samples) EXPECT_LE(sample.time, bus.now);
}

TEST_F(DeviceDriverTest, ADeviceThatStopsIsSilentAndComesBack) {
  run(1);
  device.stopped = true;
  run(3);
  EXPECT_EQ(driver.state(), LinkState::Silent);
  EXPECT_EQ(lost, 1);
  EXPECT_EQ(said.count("no valid report has come for"), 1);
  EXPECT_NE(driver.statistics().problem, "");
  device.stopped = false;
  run(1);
  EXPECT_EQ(driver.state(), LinkState::Running);
  EXPECT_EQ(said.count("sends reports again"), 1);
}

TEST_F(DeviceDriverTest, ADeviceThatStopsInTheMiddleOfAReportIsSilent) {
  run(1);
  bool cut = false;
  device.tamper = [&cut](const Packet& packet) {
    if (cut) return Packets{};
    cut = true;
    return Packets{{packet.begin(), packet.begin() + 13}};
  };
  run(1);
  EXPECT_EQ(driver.state(), LinkState::Silent);
  EXPECT_EQ(said.count("a report of 13 bytes with id 1 is truncated"), 1);
}

TEST_F(DeviceDriverTest, RefusesAnotherProtocolVersion) {
  device.tamper_feature = [](std::uint8_t id, Packet& packet) {
    if (id == vibe_firmware::kStatusReportId) packet[1] = 9;
  };
  run(5);
  EXPECT_EQ(driver.statistics().state, LinkState::Unusable);
  EXPECT_EQ(said.count("speaks version 9 of the protocol, this driver version 1; install firmware and driver of the "
                       "same release"),
            1);
  device.tamper_feature = nullptr;  // new firmware
  run(1);
  EXPECT_EQ(driver.state(), LinkState::Running);
}

TEST_F(DeviceDriverTest, RefusesAConfigurationThatCannotBe) {
  device.tamper_feature = [](std::uint8_t id, Packet& packet) {
    if (id == vibe_firmware::kAxisReportId + 1) std::fill(packet.begin() + 5, packet.begin() + 9, 0xFF);  // NaN
  };
  run(1);
  EXPECT_EQ(driver.statistics().state, LinkState::Unusable);
  EXPECT_EQ(said.count("configuration of its axis 1 has values out of range"), 1);
}

TEST_F(DeviceDriverTest, RefusesAnswersOfTheWrongSize) {
  device.tamper_feature = [](std::uint8_t, Packet& packet) { packet.resize(3); };
  run(1);
  EXPECT_EQ(said.count("Its status has 3 bytes and id 3 instead of 32 and 3"), 1);
}

TEST_F(DeviceDriverTest, ADeviceThatDoesNotAnswerHasABadCableAndNoOldFirmware) {
  device.request = [] { throw NoAnswer("Connection timed out"); };
  run(1);
  EXPECT_EQ(driver.statistics().state, LinkState::Unusable);
  EXPECT_EQ(said.count("It does not answer the request for status in time (Connection timed out); check the cable and "
                       "plug the device in again."),
            1);
  EXPECT_EQ(said.count("install firmware"), 0);
  device.request = [] { throw ReportRejected("stall"); };
  run(1);
  EXPECT_EQ(said.count("It rejects the request for status (stall); its firmware may be of another release: install "
                       "that of this one."),
            1);
}

TEST_F(DeviceDriverTest, ChoosesByTheSerialNumber) {
  FakeDevice other(DeviceKind::Input, "A0");
  bus.devices = {&device, &other};
  DeviceSelection wanted = selection();
  wanted.serial = "A1";
  DeviceDriver chooser(
      bus, DeviceKind::Input, wanted, [this] { return bus.now; }, callbacks());
  chooser.poll(kWait);
  EXPECT_EQ(chooser.statistics().serial, "A1");
  EXPECT_EQ(said.count("devices could be"), 0);
  run(0.1);
  EXPECT_EQ(driver.statistics().serial, "A0");
  EXPECT_EQ(said.count("2 devices could be the input device; /fake/A0, serial number A0 is used"), 1);
}

TEST_F(DeviceDriverTest, ReportsAnEncoderFaultOnce) {
  run(1);
  device.sample.counter = {30000, 0};
  run(1);
  EXPECT_EQ(said.count("An encoder of the input device has jumped"), 1);
}

}  // namespace
}  // namespace vibe::hardware::device_driver_test
