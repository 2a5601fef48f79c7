#include "vibe_hardware/driver/polling.hpp"

#include <gtest/gtest.h>

#include "driver/fake_devices.hpp"
#include "vibe_hardware/driver/haptic_driver.hpp"

namespace vibe::hardware::silence_watch_test {
namespace {

TEST(SilenceWatch, TellsEachSilenceOnce) {
  SilenceWatch watch;
  EXPECT_FALSE(watch.expired(1000)) << "no sample has come yet";
  EXPECT_FALSE(watch.arrived(1000));
  EXPECT_FALSE(watch.expired(1000.25));
  EXPECT_TRUE(watch.expired(1000.28));
  EXPECT_FALSE(watch.expired(1001));
  EXPECT_TRUE(watch.arrived(1002)) << "the silence ends";
  EXPECT_FALSE(watch.arrived(1002.1));
  EXPECT_TRUE(watch.expired(1003));
}

TEST(SilenceWatch, SaysNothingAboutADeviceWhoseLossTheDriverHasTold) {
  SilenceWatch watch;
  watch.arrived(1000);
  watch.stop();
  EXPECT_FALSE(watch.expired(1001));
  EXPECT_FALSE(watch.arrived(1002));
}

/// A haptic driver whose samples and losses reach a watch, and a timer that goes on while the driver is kept.
struct Watched {
  static constexpr double kTimer = 0.02;
  FakeDevice device{DeviceKind::Haptic, "H1"};
  FakeBus bus;
  SilenceWatch watch;
  std::vector<double> silences;
  int recoveries = 0, lost = 0;
  double last_sample = 0, kept_since = 0;
  HapticDriver driver{bus,
                      {vibe_firmware::kVendorId, vibe_firmware::kHapticProductId, ""},
                      [this] { return bus.now; },
                      {[this](const DeviceSample&) {
                         last_sample = bus.now;
                         recoveries += watch.arrived(bus.now) ? 1 : 0;
                       },
                       [](const DeviceConnection&) {},
                       [this](double) {
                         ++lost;
                         watch.stop();
                       },
                       [](Severity, const std::string&) {}}};

  Watched() { bus.devices = {&device}; }

  void tick() {
    if (watch.expired(bus.now)) silences.push_back(bus.now);
  }
  void run(double seconds) {
    for (const double end = bus.now + seconds; bus.now < end; tick()) {
      driver.poll(0.004);
      if (driver.device().connection() == nullptr) bus.advance(0.005);
    }
  }
  /// The next request keeps the driver for some time and is not answered.
  void hangNextRequest(double seconds) {
    device.request = [this, seconds] {
      device.request = nullptr;
      kept_since = last_sample;
      for (const double end = bus.now + seconds; bus.now < end; tick()) bus.advance(kTimer);
      throw NoAnswer("Connection timed out");
    };
  }
};

TEST(SilenceWatch, ADriverThatIsKeptByARequestIsNoticedInTime) {
  Watched node;
  node.run(1);
  node.hangNextRequest(5);
  node.run(6);
  ASSERT_EQ(node.silences.size(), 1U);
  EXPECT_LE(node.silences[0] - node.kept_since, SilenceWatch::kLimit + Watched::kTimer + 1e-6);
  EXPECT_EQ(node.lost, 0) << "the driver itself has not noticed";
  EXPECT_EQ(node.recoveries, 1);
  EXPECT_EQ(node.driver.device().state(), LinkState::Running);
}

TEST(SilenceWatch, AShortRequestIsNoSilence) {
  Watched node;
  node.run(1);
  node.hangNextRequest(0.2);
  node.run(1);
  EXPECT_TRUE(node.silences.empty());
}

TEST(SilenceWatch, TheDriverSpeaksFirstIfItCan) {
  Watched node;
  node.run(1);
  node.device.stopped = true;
  node.run(1);
  EXPECT_EQ(node.lost, 1);
  EXPECT_TRUE(node.silences.empty());
}

}  // namespace
}  // namespace vibe::hardware::silence_watch_test
