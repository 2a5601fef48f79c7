// Pulled out and plugged in again and again.

#include <gtest/gtest.h>

#include <cerrno>

#include "plugged_device.hpp"
#include "statistics.hpp"
#include "vibe_firmware/protocol/reports.hpp"

namespace vibe {
namespace {

/// The first report after plugging in: the device has started afresh.
void expectFreshReport(const std::string& hidraw) {
  HidrawFile file(hidraw);
  const auto bytes = file.read(5);
  vibe_firmware::InputReport report;
  ASSERT_TRUE(vibe_firmware::unpack(bytes.data(), bytes.size(), report)) << bytes.size() << " bytes";
  EXPECT_LT(report.sequence, 1000);
}

TEST(Replug, AReaderOfAPulledDeviceGetsAnError) {
  HidrawFile file(hapticDevice().plug().hidraw);
  ASSERT_FALSE(file.read(5).empty());
  hapticDevice().unplug();
  while (!file.read(0).empty()) {
  }
  EXPECT_NE(file.setFeature({2, 0, 0}), 0);
  hapticDevice().plug();
}

TEST(Replug, HundredCyclesOfBothDevices) {
  std::vector<double> times;
  for (int cycle = 0; cycle < 100 && !HasFatalFailure(); ++cycle) {
    for (PluggedDevice* device : {&hapticDevice(), &inputDevice()}) device->unplug();
    const double start = now();
    for (PluggedDevice* device : {&hapticDevice(), &inputDevice()}) {
      ASSERT_NO_THROW(device->plug()) << "cycle " << cycle;
      times.push_back(now() - start);
      expectFreshReport(device->plug().hidraw);
    }
  }
  EXPECT_EQ(times.size(), 200U);
  figures("from the plug to the nodes", times);
}

}  // namespace
}  // namespace vibe
