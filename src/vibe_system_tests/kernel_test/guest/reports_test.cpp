// Input reports through the kernel: every one, once, in order, in hidraw, evdev and joydev.

#include <fcntl.h>
#include <gtest/gtest.h>
#include <linux/input.h>
#include <linux/joystick.h>
#include <poll.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <functional>
#include <set>

#include "plugged_device.hpp"
#include "statistics.hpp"
#include "vibe_firmware/protocol/reports.hpp"

namespace vibe::hardware {
namespace {

using namespace vibe_firmware;

constexpr std::uint32_t kReportPeriod = 10000;  // [us]

InputReport parse(const std::vector<std::uint8_t>& bytes) {
  InputReport report;
  EXPECT_TRUE(unpack(bytes.data(), bytes.size(), report)) << bytes.size() << " bytes";
  return report;
}

/// Reports of a device with the times at which they came.
struct Recording {
  std::vector<InputReport> reports;
  std::vector<double> times;

  SequenceCount count() const {
    SequenceCount count;
    for (const InputReport& report : reports) count.add(report.sequence);
    return count;
  }
};

void read(HidrawFile& file, Recording& recording) {
  const auto bytes = file.read(5);
  ASSERT_FALSE(bytes.empty()) << "no report within 5 s";
  recording.times.push_back(now());
  recording.reports.push_back(parse(bytes));
}

Recording record(HidrawFile& file, int count) {
  Recording recording;
  for (int i = 0; i < count && !testing::Test::HasFatalFailure(); ++i) read(file, recording);
  return recording;
}

void expectEveryReport(const Recording& recording, int count) {
  const SequenceCount found = recording.count();
  EXPECT_EQ(found.received, count);
  EXPECT_EQ(found.lost, 0);
  EXPECT_EQ(found.repeated, 0);
  EXPECT_EQ(found.reordered, 0);
}

void expectEqualPeriods(const Recording& recording) {
  for (std::size_t i = 1; i < recording.reports.size(); ++i) {
    ASSERT_EQ(recording.reports[i].time_us - recording.reports[i - 1].time_us, kReportPeriod) << "report " << i;
  }
}

TEST(Reports, BothDevicesAtOnceLoseNone) {
  constexpr int kCount = 500;
  HidrawFile haptic(hapticDevice().plug().hidraw), input(inputDevice().plug().hidraw);
  Recording of_haptic, of_input;
  for (int i = 0; i < kCount && !HasFatalFailure(); ++i) {
    read(haptic, of_haptic);
    read(input, of_input);
  }
  for (const Recording* recording : {&of_haptic, &of_input}) {
    expectEveryReport(*recording, kCount);
    expectEqualPeriods(*recording);
  }
  figures("interval of input reports", differences(of_haptic.times));
}

TEST(Reports, TheImageLosesNone) {
  if (!imageRuns()) GTEST_SKIP() << "there is no firmware image; scripts/firmware builds it";
  constexpr int kCount = 300;
  HidrawFile file(imageDevice().plug().hidraw);
  const Recording recording = record(file, kCount);
  expectEveryReport(recording, kCount);
  figures("interval of input reports of the firmware image", differences(recording.times));
}

/// Reads until the condition holds for the counts, and then somewhat longer. A guest on a busy host may be seconds
/// late.
SequenceCount countUntil(HidrawFile& file, Recording recording,
                         const std::function<bool(const SequenceCount&)>& condition) {
  constexpr int kPatience = 1000, kLonger = 20;  // reports
  for (int i = 0, last = kPatience; i < last && !testing::Test::HasFatalFailure(); ++i) {
    read(file, recording);
    if (last == kPatience && condition(recording.count())) last = i + kLonger;
  }
  return recording.count();
}

TEST(Reports, ALostReportIsNoticed) {
  HidrawFile file(hapticDevice().plug().hidraw);
  const Recording begin = record(file, 1);
  tellBridge("lose haptic 1");
  const SequenceCount found = countUntil(file, begin, [](const SequenceCount& count) { return count.lost > 0; });
  EXPECT_EQ(found.lost, 1);
  EXPECT_EQ(found.repeated, 0);
}

TEST(Reports, ARepeatedReportIsNoticed) {
  HidrawFile file(hapticDevice().plug().hidraw);
  const Recording begin = record(file, 1);
  tellBridge("repeat haptic 2");
  const SequenceCount found = countUntil(file, begin, [](const SequenceCount& count) { return count.repeated > 1; });
  EXPECT_EQ(found.lost, 0);
  EXPECT_EQ(found.repeated, 2);
}

TEST(Reports, AReaderOfAPulledDeviceGetsAnError) {
  HidrawFile file(hapticDevice().plug().hidraw);
  ASSERT_FALSE(file.read(5).empty());
  hapticDevice().unplug();
  while (!file.read(0).empty()) {
  }
  EXPECT_NE(file.setFeature({2, 0, 0}), 0);
  hapticDevice().plug();
}

/// A file of events whose buffer nobody else empties.
template <class Event>
class EventFile {
 public:
  explicit EventFile(const std::string& path) : file_(open(path.c_str(), O_RDWR | O_NONBLOCK | O_CLOEXEC)) {
    EXPECT_GE(file_, 0) << path;
  }
  ~EventFile() { close(file_); }
  int get() const { return file_; }

  /// Everything that has come.
  std::vector<Event> take() {
    std::vector<Event> events;
    Event event;
    while (::read(file_, &event, sizeof event) == sizeof event) events.push_back(event);
    return events;
  }

 private:
  int file_;
};

/// Without this the kernel drops small motions: see fuzz and flat in TheAxesHaveTheirFullRange.
void clearFuzz(int file, int axis) {
  input_absinfo info{};
  ASSERT_EQ(ioctl(file, EVIOCGABS(axis), &info), 0);
  info.fuzz = info.flat = 0;
  ASSERT_EQ(ioctl(file, EVIOCSABS(axis), &info), 0);
}

std::vector<int> valuesOf(const std::vector<input_event>& events, int type, int code) {
  std::vector<int> values;
  for (const input_event& event : events) {
    EXPECT_FALSE(event.type == EV_SYN && event.code == SYN_DROPPED) << "the buffer of the event node ran over";
    if (event.type == type && event.code == code) values.push_back(event.value);
  }
  return values;
}

TEST(Reports, TheEventNodeGivesTheSameAxisValues) {
  constexpr int kCount = 100, kMargin = 10;  // the files are not opened and read at the same moment
  const UsbNodes& nodes = hapticDevice().plug();
  EventFile<input_event> event(nodes.event);
  clearFuzz(event.get(), ABS_X);
  HidrawFile file(nodes.hidraw);
  std::vector<input_event> events;
  std::vector<int> expected;
  for (int i = 0; i < kCount && !HasFatalFailure(); ++i) {
    expected.push_back(record(file, 1).reports.at(0).axes[0]);
    for (const input_event& e : event.take()) events.push_back(e);
  }
  // the hand moves axis 0 from report to report, so that each one makes an event
  const std::vector<int> values = valuesOf(events, EV_ABS, ABS_X);
  const auto found = std::search(values.begin(), values.end(), expected.begin() + kMargin, expected.end() - kMargin);
  EXPECT_NE(found, values.end()) << testing::PrintToString(values) << "\n" << testing::PrintToString(expected);
}

TEST(Reports, TheJoystickGivesTheSameButtons) {
  const UsbNodes& nodes = inputDevice().plug();
  EventFile<js_event> joystick(nodes.joy);
  HidrawFile file(nodes.hidraw);
  unsigned buttons = 0, of_reports = 0;
  std::set<int> pressed;
  for (int i = 0; i < 450 && !HasFatalFailure(); ++i) {
    of_reports = record(file, 1).reports.at(0).buttons;
    for (const js_event& e : joystick.take()) {
      if ((e.type & ~JS_EVENT_INIT) != JS_EVENT_BUTTON) continue;
      buttons = e.value ? buttons | 1U << e.number : buttons & ~(1U << e.number);
      if (e.value) pressed.insert(e.number);
    }
    // a report that has come meanwhile may be ahead
    if (i % 25 == 12) {
      EXPECT_EQ(buttons, of_reports) << "report " << i;
    }
  }
  EXPECT_EQ(pressed.size(), 16U);
}

}  // namespace
}  // namespace vibe::hardware
