// The gamepad library against the kernel: a virtual pad of uinput, and our own devices.

#include <gtest/gtest.h>
#include <linux/input.h>

#include "plugged_device.hpp"
#include "statistics.hpp"
#include "usb_nodes.hpp"
#include "vibe_hardware/gamepad/pad_source.hpp"
#include "virtual_pad.hpp"

namespace vibe::hardware {
namespace {

constexpr double kTimeout = 10;  // [s]
constexpr const char* kName = "virtual test pad";

/// Reads the pad until the condition holds.
template <class Condition>
bool updateUntil(PadSource& pad, const Condition& condition) {
  for (const double end = now() + kTimeout; now() < end;) {
    if (!pad.update(now())) return false;
    if (condition()) return true;
    usleep(1000);
  }
  return false;
}

template <class Condition>
bool waitUntil(const Condition& condition) {
  for (const double end = now() + kTimeout; now() < end; usleep(1000)) {
    if (condition()) return true;
  }
  return false;
}

class Gamepad : public testing::Test {
 protected:
  void SetUp() override {
    virtual_pad_ = std::make_unique<VirtualPad>(kName);
    const auto there = [this] { return access(virtual_pad_->eventNode().c_str(), R_OK | W_OK) == 0; };
    ASSERT_TRUE(events_.waitUntil(there, kTimeout)) << "no event node";
    std::string why;
    pad_ = openPad(kName, why);
    ASSERT_TRUE(pad_) << why;
  }

  KernelEvents events_;
  std::unique_ptr<VirtualPad> virtual_pad_;
  std::unique_ptr<PadSource> pad_;
};

TEST_F(Gamepad, AxesAndButtonsArrive) {
  virtual_pad_->send(EV_ABS, ABS_X, VirtualPad::kAxisLimit);
  virtual_pad_->send(EV_ABS, ABS_RY, -VirtualPad::kAxisLimit / 2);
  virtual_pad_->send(EV_KEY, BTN_WEST, 1);
  const auto arrived = [this] { return pad_->state().buttons.at(BTN_WEST).isPressed(); };
  ASSERT_TRUE(updateUntil(*pad_, arrived));
  EXPECT_EQ(pad_->state().axes.at(ABS_X).deflection(), 1);
  EXPECT_NEAR(pad_->state().axes.at(ABS_RY).deflection(), -0.5, 1e-4);
  EXPECT_EQ(pad_->state().axes.at(ABS_Y).deflection(), 0);
  EXPECT_FALSE(pad_->state().buttons.at(BTN_EAST).down);
}

TEST_F(Gamepad, TheMotorsRumbleAsStronglyAsAsked) {
  PadMotors* motors = pad_->motors();
  ASSERT_TRUE(motors);
  ASSERT_TRUE(motors->hasRumble());
  ASSERT_TRUE(motors->rumble(0.75, 0.25));
  ff_effect effect{};
  ASSERT_TRUE(waitUntil([&] { return virtual_pad_->playing(FF_RUMBLE, effect); }));
  EXPECT_NEAR(effect.u.rumble.strong_magnitude, 0.75 * 0xFFFF, 1);
  EXPECT_NEAR(effect.u.rumble.weak_magnitude, 0.25 * 0xFFFF, 1);
  ASSERT_TRUE(motors->rumble(0, 1));  // the same effect anew
  ASSERT_TRUE(virtual_pad_->playing(FF_RUMBLE, effect));
  EXPECT_EQ(effect.u.rumble.strong_magnitude, 0);
  EXPECT_EQ(effect.u.rumble.weak_magnitude, 0xFFFF);
}

TEST_F(Gamepad, TheSpringOfEachAxisIsAsAsked) {
  PadMotors* motors = pad_->motors();
  ASSERT_TRUE(motors);
  ASSERT_TRUE(motors->hasSpring());
  ASSERT_TRUE(motors->spring({{{0.5, 0.25}, {-1, 1}}}));
  ff_effect effect{};
  ASSERT_TRUE(waitUntil([&] { return virtual_pad_->playing(FF_SPRING, effect); }));
  EXPECT_NEAR(effect.u.condition[0].center, 0.5 * 0x7FFF, 1);
  EXPECT_NEAR(effect.u.condition[0].right_coeff, 0.25 * 0x7FFF, 1);
  EXPECT_EQ(effect.u.condition[0].left_coeff, effect.u.condition[0].right_coeff);
  EXPECT_EQ(effect.u.condition[1].center, -0x7FFF);
  EXPECT_EQ(effect.u.condition[1].right_coeff, 0x7FFF);
}

TEST_F(Gamepad, WhatIsClosedStopsItsMotors) {
  ASSERT_TRUE(pad_->motors()->rumble(1, 1));
  ff_effect effect{};
  ASSERT_TRUE(waitUntil([&] { return virtual_pad_->playing(FF_RUMBLE, effect); }));
  pad_.reset();
  EXPECT_TRUE(waitUntil([&] { return !virtual_pad_->playing(FF_RUMBLE, effect); }));
}

TEST_F(Gamepad, AnUnpluggedPadIsGone) {
  virtual_pad_.reset();
  EXPECT_TRUE(waitUntil([this] { return !pad_->update(now()); }));
  std::string why;
  EXPECT_FALSE(openPad(kName, why));
  EXPECT_NE(why.find(kName), std::string::npos) << why;
}

TEST(GamepadOfOurs, TheInputDeviceDrivesLikeAnyGamepad) {
  const UsbNodes& nodes = inputDevice().plug();
  std::string why;
  const auto pad = openPad(nodes.event, why);
  ASSERT_TRUE(pad) << why;
  EXPECT_EQ(pad->state().axes.size(), 2U);
  EXPECT_EQ(pad->state().buttons.size(), 16U);
  const double from = pad->state().axes.at(ABS_Y).deflection();
  const auto moved = [&] { return std::abs(pad->state().axes.at(ABS_Y).deflection() - from) > 0.01; };
  EXPECT_TRUE(updateUntil(*pad, moved));
  EXPECT_FALSE(pad->motors() && (pad->motors()->hasRumble() || pad->motors()->hasSpring()));
}

}  // namespace
}  // namespace vibe::hardware
