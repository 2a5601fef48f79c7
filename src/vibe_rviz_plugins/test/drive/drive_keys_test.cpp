#include "vibe_rviz_plugins/drive/drive_keys.hpp"

#include <gtest/gtest.h>
#include <qnamespace.h>

#include <set>

namespace vibe::rviz_plugins::drive_keys_test {
namespace {

TEST(DriveKeys, EveryKeyHasOneMeaning) {
  std::set<int> keys;
  for (const KeyBinding& binding : keyBindings()) EXPECT_TRUE(keys.insert(binding.key).second) << binding.key;
  EXPECT_EQ(findBinding(Qt::Key_W)->index, Insertion);
  EXPECT_EQ(findBinding(Qt::Key_M), nullptr);
}

TEST(DriveKeys, KeysOfTheToolAndOfRvizStayFree) {
  for (const int key : {Qt::Key_H, Qt::Key_F1, Qt::Key_V, Qt::Key_Escape, Qt::Key_F11, Qt::Key_Control, Qt::Key_Alt})
    EXPECT_EQ(findBinding(key), nullptr) << key;
}

TEST(DriveKeys, TableExplainsEveryKey) {
  std::set<int> shown;
  for (const KeyRow& row : keyRows())
    for (const KeyRow::Cap& cap : row.caps) shown.insert(cap.key);
  for (const KeyBinding& binding : keyBindings())
    EXPECT_TRUE(shown.count(binding.key) > 0 || binding.key == Qt::Key_Y) << "key " << binding.key;
  EXPECT_TRUE(shown.count(Qt::Key_H) > 0);
}

TEST(DriveKeys, JointNamesAreThoseOfTheUrdf) {
  EXPECT_EQ(driveJointNames()[TipLeftRight], "tip_left_right");
  EXPECT_EQ(driveJointNames()[NeedleDriver], "needle_driver");
}

}  // namespace
}  // namespace vibe::rviz_plugins::drive_keys_test
