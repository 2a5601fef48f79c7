#include "vibe_operator/drive/drive_keys.hpp"

#include <gtest/gtest.h>
#include <initializer_list>
#include <set>

namespace vibe::operating::drive_keys_test {
namespace {

TEST(DriveKeys, EveryKeyHasOneMeaning) {
  std::set<int> keys;
  for (const KeyBinding& binding : keyBindings()) EXPECT_TRUE(keys.insert(binding.key).second) << binding.key;
  EXPECT_EQ(findBinding('W')->index, Insertion);
  EXPECT_EQ(findBinding('M'), nullptr);
}

TEST(DriveKeys, ReachAllOfTheProcedure) {
  std::set<std::array<int, 3>> reached;
  for (const KeyBinding& binding : keyBindings())
    reached.insert({static_cast<int>(binding.kind), binding.index, binding.sign});
  for (int joint = 0; joint < kJointCount; ++joint)
    for (const int sign : {-1, 1})
      EXPECT_EQ(reached.count({static_cast<int>(KeyBinding::Kind::Joint), joint, sign}), 1U)
          << driveJointNames()[joint];
  for (int button = 0; button < 6; ++button)
    EXPECT_EQ(reached.count({static_cast<int>(KeyBinding::Kind::Button), button, 0}), 1U) << button;
}

TEST(DriveKeys, KeysOfTheToolAndOfRvizStayFree) {
  for (const int key :
       std::initializer_list<int>{'H', 0x01000030, 'V', keys::kEscape, 0x0100003a, 0x01000021, 0x01000023})
    EXPECT_EQ(findBinding(key), nullptr) << key;
}

TEST(DriveKeys, TableExplainsEveryKey) {
  std::set<int> shown;
  for (const KeyRow& row : keyRows())
    for (const KeyRow::Cap& cap : row.caps) shown.insert(cap.key);
  for (const KeyBinding& binding : keyBindings())
    EXPECT_TRUE(shown.count(binding.key) > 0 || binding.key == 'Y') << "key " << binding.key;
  EXPECT_TRUE(shown.count('H') > 0);
}

TEST(DriveKeys, JointNamesAreThoseOfTheUrdf) {
  EXPECT_EQ(driveJointNames()[TipLeftRight], "tip_left_right");
  EXPECT_EQ(driveJointNames()[NeedleDriver], "needle_driver");
}

}  // namespace
}  // namespace vibe::operating::drive_keys_test
