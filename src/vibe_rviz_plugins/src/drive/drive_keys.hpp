#pragma once
#include <array>
#include <string>
#include <vector>

namespace vibe::rviz_plugins {

constexpr int kJointCount = 7;
/// In the order of StepInput.
enum DriveJoint : int { Insertion, Rotation, TipUpDown, TipLeftRight, HelixAdvance, HelixRotation, NeedleDriver };
using Joints = std::array<double, kJointCount>;  ///< [m] or [rad]

/// Names in the URDF and in messages.
const std::array<std::string, kJointCount>& driveJointNames();

enum class DriveGear { Slow, Normal, Fast };

/// What a key does.
struct KeyBinding {
  enum class Kind {
    Joint,    ///< moves the joint `index` in the direction `sign` while it is held
    Button,   ///< presses the button `index` of scope/buttons
    Gear,     ///< chooses the speed `index` from now on
    SlowDown  ///< the slow speed while it is held
  };
  int key;  ///< Qt::Key
  Kind kind;
  int index;
  int sign;
};

/// All keys that drive. A key occurs once. Single letters, digits, arrows, space and Shift only: shortcuts of rviz with
/// Ctrl and Alt keep their meaning.
const std::vector<KeyBinding>& keyBindings();
/// Null for a key that does not drive.
const KeyBinding* findBinding(int key);

/// A line of the table of keys that is shown to the player.
struct KeyRow {
  struct Cap {
    int key;            ///< Qt::Key; 0: only a label, such as "wheel"
    std::string label;  ///< on the key
  };
  std::vector<Cap> caps;
  std::string text;
  bool ends_group = false;  ///< a gap follows
};
const std::vector<KeyRow>& keyRows();

}  // namespace vibe::rviz_plugins
