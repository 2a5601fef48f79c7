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
