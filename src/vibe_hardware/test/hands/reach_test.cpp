// Whatever hand a mapping is for, it reaches every joint and button of the procedure, alone or with the other hand.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <map>
#include <string>
#include <vector>

#include "gamepad/pads.hpp"
#include "vibe_hardware/crtk/teleop_mapping.hpp"
#include "vibe_hardware/driver/calibration.hpp"

namespace vibe::hardware::reach_test {
namespace {

using Names = std::vector<std::string>;

/// What the mappings of a folder do not reach, by the name of the file.
template <class Load>
std::map<std::string, Names> missingIn(const std::string& folder, const Load& load) {
  std::map<std::string, Names> missing;
  for (const auto& file : std::filesystem::directory_iterator(folder))
    if (file.path().extension() == ".yaml")
      missing[file.path().stem()] = unreachable(load(file.path().string(), toolLimits()));
  return missing;
}

Names both(Names one, Names other) {
  std::sort(one.begin(), one.end());
  std::sort(other.begin(), other.end());
  Names common;
  std::set_intersection(one.begin(), one.end(), other.begin(), other.end(), std::back_inserter(common));
  return common;
}

TEST(Reach, EveryArmReachesAllOfTheProcedureAloneOrBesideTheOther) {
  std::map<std::string, Names> missing = missingIn("../config/arms", loadTeleopMapping);
  const Names left = missing.at("dvrk_left"), right = missing.at("dvrk_right");
  missing["dvrk_left"] = missing["dvrk_right"] = both(left, right);
  for (const auto& [name, names] : missing) EXPECT_EQ(names, Names()) << name;
  EXPECT_EQ(left, (Names{"helix_advance", "helix_rotation", "needle_driver"}));  // neither does so alone
  EXPECT_EQ(right.size(), kScopeJointCount + kButtonCount);
}

TEST(Reach, EveryPadReachesAllOfTheProcedure) {
  for (const auto& [name, names] : missingIn("../config/gamepads", loadPadMapping)) EXPECT_EQ(names, Names()) << name;
  EXPECT_EQ(unreachable(mappingOf("joints: {}\nbuttons: {cinch: {button: BTN_WEST}}\n")).size(),
            kJointCount + kButtonCount - 1);
}

TEST(Reach, TheDevicesReachAllOfTheProcedure) {
  const Calibration devices = Calibration::load("../config/devices.yaml");
  for (std::size_t b = 0; b < kButtonCount; ++b) EXPECT_TRUE(devices.buttons[b]) << kButtonNames[b];
  EXPECT_TRUE(devices.suturing_device);
}

}  // namespace
}  // namespace vibe::hardware::reach_test
