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

/// Where a player stands.
struct DriveSituation {
  Joints joints{};
  double closed = 0;     ///< upper limit of the needle driver [m]
  bool gas_on = false;   ///< the insufflator's button is down
  double pressure = 0;   ///< gauge, of the gas [Pa]
  bool touches = false;  ///< the tool touches tissue
  bool holds = false;    ///< the helix holds tissue
  bool needle_loaded = true, needle_on_arm = true;
  unsigned marks = 0;
  unsigned set_bites = 0;    ///< of the set at work
  unsigned sets_tagged = 0;  ///< with a T-tag, not cinched
  unsigned sets_done = 0;    ///< cinched
};

/// The next thing to do, in the order of the first set of sutures.
struct FirstStep {
  int number = 0;    ///< from 1
  std::string text;  ///< one sentence with the key to press
};
constexpr int kFirstSteps = 12;
FirstStep firstStep(const DriveSituation& now);

}  // namespace vibe::rviz_plugins
