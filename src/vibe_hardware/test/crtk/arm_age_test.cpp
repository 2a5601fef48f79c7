// Which arms are told that their measurements come late.
#include "vibe_hardware/crtk/arm_age.hpp"

#include <gtest/gtest.h>

#include <filesystem>

#include "gamepad/pads.hpp"

namespace vibe::hardware::arm_age_test {
namespace {

/// What only moves the suturing device, or is sent no force, has no energy to keep account of.
TEST(ArmAge, OnlyAnArmThatGetsForcesIsToldOfADelay) {
  int with = 0, without = 0;
  for (const auto& file : std::filesystem::directory_iterator("../config/arms")) {
    const TeleopMapping mapping = loadTeleopMapping(file.path(), toolLimits());
    const double delay = largestDelay(mapping), late = 0.5 * (delay + mapping.timeout);
    const bool forces = mapping.force_scale != 0 && !mapping.device_only;
    ASSERT_LT(delay, mapping.timeout) << mapping.name;
    EXPECT_EQ(latenessOf(mapping, late).key, forces ? "delay" : "") << mapping.name;
    EXPECT_EQ(latenessOf(mapping, delay).key, "") << mapping.name;
    EXPECT_EQ(latenessOf(mapping, 1.01 * mapping.timeout).key, "timeout") << mapping.name;
    ++(forces ? with : without);
  }
  EXPECT_GT(with, 1);
  EXPECT_GT(without, 1);
}

TEST(ArmAge, TimesAreWrittenInMilliseconds) {
  EXPECT_EQ(inMilliseconds(0.000433), "0.433 ms");
  EXPECT_EQ(inMilliseconds(0.1), "100 ms");
}

}  // namespace
}  // namespace vibe::hardware::arm_age_test
