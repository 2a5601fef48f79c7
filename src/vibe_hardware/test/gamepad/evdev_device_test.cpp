#include "gamepad/evdev_pad.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "vibe_firmware/protocol/descriptors.hpp"
#include "vibe_hardware/gamepad/pad_source.hpp"

namespace vibe::hardware::evdev_device_test {
namespace {

/// libevdev's description of a device without a file.
class Description {
 public:
  explicit Description(const char* name) : device_(libevdev_new()) { libevdev_set_name(device_.get(), name); }
  void axis(unsigned code, int minimum, int maximum, int value) {
    input_absinfo info{};
    info.minimum = minimum;
    info.maximum = maximum;
    info.value = value;
    libevdev_enable_event_code(device_.get(), EV_ABS, code, &info);
  }
  void button(unsigned code) { libevdev_enable_event_code(device_.get(), EV_KEY, code, nullptr); }
  void id(int vendor, int product) {
    libevdev_set_id_vendor(device_.get(), vendor);
    libevdev_set_id_product(device_.get(), product);
  }
  libevdev& get() { return *device_; }

 private:
  std::unique_ptr<libevdev, LibevdevDeleter> device_;
};

Description gamepad() {
  Description device("Test pad");
  device.axis(ABS_X, -100, 100, 20);
  device.axis(ABS_Y, 0, 255, 128);
  device.button(BTN_SOUTH);
  return device;
}

TEST(EvdevDevice, GamepadsAndJoysticksArePads) {
  EXPECT_TRUE(isPad(gamepad().get()));
  Description stick("Flight stick");
  stick.axis(ABS_X, 0, 1023, 512);
  stick.axis(ABS_Y, 0, 1023, 512);
  stick.button(BTN_TRIGGER);
  EXPECT_TRUE(isPad(stick.get()));
}

TEST(EvdevDevice, KeyboardsTouchpadsAndAccelerometersAreNot) {
  Description keyboard("Keyboard");
  keyboard.button(KEY_A);
  EXPECT_FALSE(isPad(keyboard.get()));
  Description touchpad("Touchpad");
  touchpad.axis(ABS_X, 0, 4000, 0);
  touchpad.axis(ABS_Y, 0, 3000, 0);
  touchpad.button(BTN_LEFT);
  touchpad.button(BTN_TOUCH);
  EXPECT_FALSE(isPad(touchpad.get()));
  Description sensor = gamepad();
  libevdev_enable_property(&sensor.get(), INPUT_PROP_ACCELEROMETER);
  EXPECT_FALSE(isPad(sensor.get()));
}

TEST(EvdevDevice, DevicesOfTheScopeAreTakenOnlyByName) {
  for (const int product : {vibe_firmware::kHapticProductId, vibe_firmware::kInputProductId}) {
    Description device = gamepad();
    device.id(vibe_firmware::kVendorId, product);
    EXPECT_TRUE(isPad(device.get()));
    EXPECT_FALSE(isWanted("", device.get(), "/dev/input/event3"));
    EXPECT_TRUE(isWanted("Test", device.get(), "/dev/input/event3"));
  }
  Description other = gamepad();
  for (const auto& [vendor, product] : {std::pair(0x045E, 0x0001), std::pair(0x1209, 0x0003)}) {
    other.id(vendor, product);  // another vendor, or another device of this shared vendor id
    EXPECT_TRUE(isWanted("", other.get(), "/dev/input/event3"));
  }
}

TEST(EvdevDevice, StateHasRangesAndPresentValues) {
  Description device = gamepad();
  libevdev_set_event_value(&device.get(), EV_KEY, BTN_SOUTH, 1);
  const PadState state = stateOf(device.get());
  ASSERT_EQ(state.axes.size(), 2u);
  EXPECT_NEAR(state.axes.at(ABS_X).deflection(), 0.2, 1e-12);
  EXPECT_NEAR(state.axes.at(ABS_Y).deflection(), 0.0039, 1e-4);
  EXPECT_TRUE(state.buttons.at(BTN_SOUTH).down);
  EXPECT_FALSE(state.buttons.at(BTN_SOUTH).isPressed());  // only after it has been released
}

TEST(EvdevDevice, InfoSaysWhichMotorsThereAre) {
  Description device = gamepad();
  EXPECT_FALSE(infoOf(device.get(), "/dev/input/event3").has_rumble);
  libevdev_enable_event_code(&device.get(), EV_FF, FF_RUMBLE, nullptr);
  libevdev_enable_event_code(&device.get(), EV_FF, FF_SPRING, nullptr);
  const PadInfo info = infoOf(device.get(), "/dev/input/event3");
  EXPECT_EQ(info.name, "Test pad");
  EXPECT_EQ(info.phys, "");
  EXPECT_EQ(info.path, "/dev/input/event3");
  EXPECT_TRUE(info.has_rumble);
  EXPECT_TRUE(info.has_spring);
}

TEST(PadFinder, SaysWhatItLookedForAndWhatItSaw) {
  const std::filesystem::path folder = std::filesystem::path(testing::TempDir()) / "pad_finder";
  std::filesystem::create_directories(folder);
  std::string why;
  EXPECT_EQ(openPad("", why, (folder / "none").string()), nullptr);
  EXPECT_NE(why.find("No gamepad found: there is no input device in"), std::string::npos) << why;
  std::ofstream(folder / "event7") << "no device";
  std::ofstream(folder / "mouse0") << "not looked at";
  EXPECT_EQ(openPad("", why, folder.string()), nullptr);
  EXPECT_NE(why.find("1 input device in"), std::string::npos) << why;
  EXPECT_NE(why.find("1 of them is no event device"), std::string::npos) << why;
  EXPECT_EQ(openPad("Xbox", why, folder.string()), nullptr);
  EXPECT_NE(why.find("No device found with 'Xbox' in its name or phys"), std::string::npos) << why;
  EXPECT_EQ(openPad("/dev/input/event99", why, folder.string()), nullptr);
  EXPECT_NE(why.find("'/dev/input/event99' cannot be opened"), std::string::npos) << why;
  const std::vector<PadListing> listings = listInputDevices(folder.string());
  ASSERT_EQ(listings.size(), 1u);
  EXPECT_NE(listings[0].problem, "");
  std::filesystem::remove_all(folder);
}

}  // namespace
}  // namespace vibe::hardware::evdev_device_test
