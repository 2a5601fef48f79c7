// Pulled out and plugged in again and again. A program of its own, which runs beside the other tests: most of the time
// it waits for the kernel to be sure that a contact is firm.

#include <fcntl.h>
#include <gtest/gtest.h>
#include <syslog.h>
#include <unistd.h>

#include <cerrno>
#include <string>
#include <thread>
#include <vector>

#include "plugged_device.hpp"
#include "statistics.hpp"
#include "vibe_firmware/protocol/reports.hpp"

namespace vibe::hardware {
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

/// Messages of the kernel since it has started, with their priorities.
std::vector<std::string> kernelLog() {
  std::vector<std::string> messages;
  const int file = open("/dev/kmsg", O_RDONLY | O_NONBLOCK | O_CLOEXEC);
  std::string message(8192, '\0');
  for (;;) {
    const ssize_t size = read(file, message.data(), message.size());
    if (size < 0 && errno == EPIPE) continue;  // overwritten before it was read
    if (size <= 0) break;
    messages.push_back(message.substr(0, static_cast<std::size_t>(size)));
  }
  close(file);
  return messages;
}

/// A message "PRIORITY,NUMBER,TIME,...;TEXT" that tells of a fault of the kernel, or an error of USB or HID.
bool tellsOfFault(const std::string& message) {
  const bool is_error = (std::stoi(message) & 7) <= LOG_ERR;
  const auto has = [&](const char* text) { return message.find(text) != std::string::npos; };
  return has("BUG:") || has("WARNING: CPU") || has("Oops") || (is_error && (has("usb") || has("hid")));
}

TEST(Replug, TheKernelTellsOfNoFault) {
  const std::vector<std::string> messages = kernelLog();
  EXPECT_GT(messages.size(), 10U);
  for (const std::string& message : messages) EXPECT_FALSE(tellsOfFault(message)) << message;
  EXPECT_TRUE(tellsOfFault("3,1,1,-;usb 1-1: device descriptor read/64, error -71"));
}

}  // namespace
}  // namespace vibe::hardware
