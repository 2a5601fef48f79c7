// Pulled out and plugged in again and again. A program of its own, which runs beside the other tests: most of the time
// it waits for the kernel to be sure that a contact is firm.

#include <gtest/gtest.h>

#include <thread>
#include <vector>

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

/// Pulls the device out and plugs it in again; adds the times from the plug to the nodes [s].
void replug(PluggedDevice& device, int cycles, std::vector<double>& times) {
  for (int cycle = 0; cycle < cycles && !testing::Test::HasFatalFailure(); ++cycle) {
    ASSERT_NO_THROW(device.unplug()) << device.name() << ", cycle " << cycle;
    const double start = now();
    ASSERT_NO_THROW(device.plug()) << device.name() << ", cycle " << cycle;
    times.push_back(now() - start);
    expectFreshReport(device.plug().hidraw);
  }
}

TEST(Replug, HundredCyclesOfEachDevice) {
  constexpr int kCycles = 100;
  std::vector<double> haptic_times, input_times;
  std::thread haptic([&] { replug(spareHapticDevice(), kCycles, haptic_times); });
  replug(spareInputDevice(), kCycles, input_times);
  haptic.join();
  EXPECT_EQ(haptic_times.size(), kCycles);
  EXPECT_EQ(input_times.size(), kCycles);
  figures("from the plug to the nodes", haptic_times);
}

}  // namespace
}  // namespace vibe
