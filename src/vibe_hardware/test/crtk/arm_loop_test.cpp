// The energy at an arm over a whole link: what crtk_teleop does keeps the bound where the mapping says how slow the
// link is, and says so where it does not.
#include "vibe_hardware/emulator/arm_loop.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "gamepad/pads.hpp"

namespace vibe::hardware::arm_loop_test {
namespace {

const TeleopMapping& touch() {
  static const TeleopMapping mapping = loadTeleopMapping("../config/arms/touch.yaml", toolLimits());
  return mapping;
}

TeleopMapping withDelay(double delay, double timeout) {
  TeleopMapping mapping = touch();
  mapping.timeout = timeout;
  for (HandJoint& joint : mapping.joints) joint.port.delay = delay;
  return mapping;
}

std::vector<HandAtArm> hands() {
  return {swayingHand(8e-3, 4), lightHand(0.02, 1), yieldingHand(0.02)};
}

TEST(ArmLoop, NoLinkThatTheMappingKnowsGivesMoreThanTheBound) {
  int beyond_without = 0;
  for (const double delay : {0.01, 0.03, 0.1}) {
    TeleopMapping mapping = withDelay(delay + 5e-3, delay + 0.1), free = mapping;
    for (HandJoint& joint : free.joints) joint.port.capacity = 1e9, joint.port.damping_limit = 0;
    for (const HandAtArm& hand : hands()) {
      const ArmLink link{delay, delay, delay, 0.05};
      const ArmLoopResult with = runArmLoop({mapping, link, hand, 300, 4});
      EXPECT_LE(with.beyond, 0) << delay;
      EXPECT_EQ(with.warnings.count("delay") + with.warnings.count("overdrawn"), 0U) << delay;
      beyond_without += runArmLoop({free, link, hand, 300, 4}).most > 0.05 ? 1 : 0;
    }
  }
  EXPECT_GE(beyond_without, 5);  // negative control
}

TEST(ArmLoop, ALinkThatIsSlowerThanTheMappingSaysIsReckonedWithAndSaid) {
  for (const HandAtArm& hand : hands()) {
    const ArmLoopResult slow = runArmLoop({touch(), {0.04, 0.04}, hand, 300, 4});
    EXPECT_LE(slow.beyond, 0);
    EXPECT_EQ(slow.warnings.count("delay"), 1U);
    const ArmLoopResult quick = runArmLoop({touch(), {0.004, 0.004}, hand, 300, 4});
    EXPECT_EQ(quick.warnings.count("delay"), 0U);
  }
}

TEST(ArmLoop, NoOutageIsBeyondTheBoundWithoutAWord) {
  for (const double outage : {0.08, 0.4})
    for (const HandAtArm& hand : hands()) {
      const ArmLoopResult result = runArmLoop({touch(), {0.005, 0.005, 0, 0, outage}, hand, 300, 4});
      if (result.beyond > 0) {
        EXPECT_GT(result.warnings.count("silent") + result.warnings.count("overdrawn"), 0U);
      }
      if (outage > touch().timeout) {
        EXPECT_EQ(result.warnings.count("silent"), 1U);
      }
    }
}

TEST(ArmLoop, AHandThatIsFasterThanTheMappingSaysIsSaid) {
  TeleopMapping slower = withDelay(0.035, 0.2);
  for (HandJoint& joint : slower.joints) joint.port.speed_limit = 0.2;
  const ArmLoopResult result = runArmLoop({slower, {0.03, 0.03}, yieldingHand(0.02), 300, 4});
  EXPECT_EQ(result.warnings.count("overdrawn"), 1U);
}

TEST(ArmLoop, ASlowHandFeelsTheTissue) {
  const ArmLoopResult result = runArmLoop({touch(), {2e-3, 2e-3}, swayingHand(5e-3, 0.5), 300, 4});
  EXPECT_LT(result.error, 0.12 * 300 * 5e-3 * 0.7);
}

}  // namespace
}  // namespace vibe::hardware::arm_loop_test
