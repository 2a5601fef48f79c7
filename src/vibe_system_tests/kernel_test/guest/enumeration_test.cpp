// What the kernel makes of the firmware's descriptors.

#include <fcntl.h>
#include <gtest/gtest.h>
#include <linux/input.h>
#include <linux/joystick.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <numeric>
#include <vector>

#include "plugged_device.hpp"
#include "statistics.hpp"
#include "vibe_firmware/protocol/descriptors.hpp"

namespace vibe::hardware {
namespace {

using vibe_firmware::kHapticReportDescriptor;
using vibe_firmware::kInputReportDescriptor;

constexpr int kButtons = 16;

struct Expected {
  PluggedDevice& (*device)();
  std::vector<std::uint8_t> report_descriptor;
};

void PrintTo(const Expected& expected, std::ostream* out) {
  *out << expected.device().name();
}

const std::vector<std::uint8_t> kHapticDescriptor(std::begin(kHapticReportDescriptor),
                                                  std::end(kHapticReportDescriptor));
const std::vector<std::uint8_t> kInputDescriptor(std::begin(kInputReportDescriptor), std::end(kInputReportDescriptor));

class Enumeration : public testing::TestWithParam<Expected> {
 protected:
  void SetUp() override {
    if (device().name() == "image" && !imageRuns()) GTEST_SKIP() << "no firmware image; scripts/firmware builds it";
  }

  PluggedDevice& device() { return GetParam().device(); }
};

INSTANTIATE_TEST_SUITE_P(Usb, Enumeration,
                         testing::Values(Expected{hapticDevice, kHapticDescriptor},
                                         Expected{inputDevice, kInputDescriptor},
                                         Expected{imageDevice, kHapticDescriptor}),
                         [](const auto& test) { return test.param.device().name(); });

/// Numbers of the bits that are set.
template <std::size_t N>
std::vector<int> bitsOf(const unsigned char (&bytes)[N]) {
  std::vector<int> set;
  for (std::size_t bit = 0; bit < 8 * N; ++bit) {
    if (bytes[bit / 8] >> (bit % 8) & 1) set.push_back(static_cast<int>(bit));
  }
  return set;
}

/// The codes of one kind of event that an input device has.
template <std::size_t Codes>
std::vector<int> eventCodes(int file, int type) {
  unsigned char bits[Codes / 8 + 1] = {};
  EXPECT_GE(ioctl(file, EVIOCGBIT(type, sizeof bits), bits), 0);
  return bitsOf(bits);
}

std::vector<int> gamepadButtons() {
  std::vector<int> buttons(kButtons);
  std::iota(buttons.begin(), buttons.end(), BTN_GAMEPAD);
  return buttons;
}

class File {
 public:
  explicit File(const std::string& path) : descriptor_(open(path.c_str(), O_RDWR | O_NONBLOCK | O_CLOEXEC)) {}
  ~File() { close(descriptor_); }
  int get() const { return descriptor_; }

 private:
  int descriptor_;
};

TEST_P(Enumeration, TheKernelReadsTheDescriptorsOfTheFirmware) {
  const UsbNodes& nodes = device().plug();
  const auto device_bytes = vibe_firmware::deviceDescriptor(device().usb().product);
  const auto configuration = vibe_firmware::configurationDescriptor(GetParam().report_descriptor.size());
  std::string expected(device_bytes.begin(), device_bytes.end());
  expected.append(configuration.begin(), configuration.end());
  std::string read = readAttribute(nodes.usb + "/descriptors");
  EXPECT_EQ(read, expected);
  EXPECT_EQ(HidrawFile(nodes.hidraw).reportDescriptor(), GetParam().report_descriptor);
}

TEST_P(Enumeration, ItHasAManufacturerAProductAndASerialNumber) {
  const UsbNodes& nodes = device().plug();
  for (const char* text : {"/manufacturer", "/product", "/serial"}) {
    EXPECT_FALSE(readAttribute(nodes.usb + text).empty()) << text;
  }
  EXPECT_EQ(readAttribute(nodes.usb + "/speed"), "12");
}

TEST_P(Enumeration, HidrawEventAndJsNodesAppear) {
  const UsbNodes& nodes = device().plug();
  for (const std::string& node : {nodes.hidraw, nodes.event, nodes.joy}) {
    EXPECT_GE(File(node).get(), 0) << node;
  }
}

TEST_P(Enumeration, TwoAxesAndSixteenButtonsMakeAGamepad) {
  const File file(device().plug().event);
  EXPECT_EQ(eventCodes<ABS_CNT>(file.get(), EV_ABS), (std::vector<int>{ABS_X, ABS_Y}));
  EXPECT_EQ(eventCodes<KEY_CNT>(file.get(), EV_KEY), gamepadButtons());
  EXPECT_TRUE(eventCodes<REL_CNT>(file.get(), EV_REL).empty());
}

TEST_P(Enumeration, TheAxesHaveTheirFullRange) {
  if (device().name() != "image") device().unplug();  // another test may have changed fuzz and flat
  const File file(device().plug().event);
  for (const int axis : {ABS_X, ABS_Y}) {
    input_absinfo info{};
    ASSERT_EQ(ioctl(file.get(), EVIOCGABS(axis), &info), 0);
    EXPECT_EQ(info.minimum, -32767);
    EXPECT_EQ(info.maximum, 32767);
    if (axis == ABS_X && device().name() == "haptic") {
      figure("fuzz that the kernel sets on an axis", info.fuzz, "of 32767");
      figure("dead zone that the kernel sets on an axis", info.flat, "of 32767");
    }
  }
}

TEST_P(Enumeration, TheJoystickHasTheSameAxesAndButtons) {
  const File file(device().plug().joy);
  unsigned char axes = 0, buttons = 0;
  ASSERT_EQ(ioctl(file.get(), JSIOCGAXES, &axes), 0);
  ASSERT_EQ(ioctl(file.get(), JSIOCGBUTTONS, &buttons), 0);
  EXPECT_EQ(axes, 2);
  EXPECT_EQ(buttons, kButtons);
  std::uint16_t codes[KEY_MAX - BTN_MISC + 1] = {};
  ASSERT_GE(ioctl(file.get(), JSIOCGBTNMAP, codes), 0);
  EXPECT_EQ(std::vector<int>(codes, codes + kButtons), gamepadButtons());
}

}  // namespace
}  // namespace vibe::hardware
