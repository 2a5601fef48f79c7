#include "vibe_hardware/gamepad/pad_source.hpp"

#include <gtest/gtest.h>

#include "gamepad/pads.hpp"

namespace vibe::hardware::pad_link_test {
namespace {

/// A pad that is there until the test unplugs it.
class TestPad : public PadSource {
 public:
  explicit TestPad(const bool& plugged) : plugged_(plugged) {
    info_.name = "Test pad";
    info_.path = "/dev/input/event3";
  }
  const PadInfo& info() const override { return info_; }
  bool update(double) override { return plugged_; }
  const PadState& state() const override { return state_; }
  PadMotors* motors() override { return nullptr; }
  std::uint64_t eventCount() const override { return 0; }
  std::uint64_t dropCount() const override { return 0; }
  void setListener(std::function<void(const PadEvent&)>) override {}

 private:
  const bool& plugged_;
  PadInfo info_;
  PadState state_ = twoStickPad();
};

class PadLinkTest : public testing::Test {
 protected:
  bool plugged_ = false;
  int attempts_ = 0;
  PadLink link_{[this](std::string& why) -> std::unique_ptr<PadSource> {
    ++attempts_;
    if (plugged_) return std::make_unique<TestPad>(plugged_);
    why = "No gamepad found.";
    return nullptr;
  }};

  /// Polls 100 times a second; all that was said.
  std::string pollFor(double begin, double seconds) {
    std::string said;
    for (int k = 0; k < static_cast<int>(100 * seconds); ++k) said += link_.poll(begin + 0.01 * k);
    return said;
  }
};

TEST_F(PadLinkTest, SaysOnceThatThereIsNoneAndKeepsWaiting) {
  EXPECT_EQ(pollFor(0, 10), "No gamepad found. Waiting for it.");
  EXPECT_NEAR(attempts_, 20, 1);
  plugged_ = true;
  EXPECT_EQ(pollFor(10, 1), "Found the gamepad 'Test pad' at /dev/input/event3.");
  EXPECT_NE(link_.pad(), nullptr);
}

TEST_F(PadLinkTest, FindsAPadThatReturnsWithinASecond) {
  plugged_ = true;
  EXPECT_EQ(link_.poll(0), "Found the gamepad 'Test pad' at /dev/input/event3.");
  EXPECT_EQ(pollFor(0.1, 1), "");
  plugged_ = false;
  EXPECT_EQ(
      link_.poll(2),
      "The gamepad 'Test pad' is gone: its buttons are released and the joints stay where they are. Waiting for it.");
  EXPECT_EQ(link_.pad(), nullptr);
  EXPECT_EQ(pollFor(2.01, 3), "");
  plugged_ = true;
  EXPECT_NE(pollFor(5.02, 0.99), "");
  EXPECT_EQ(link_.connections(), 2u);
}

}  // namespace
}  // namespace vibe::hardware::pad_link_test
