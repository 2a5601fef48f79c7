#pragma once

#include <array>
#include <string>
#include <vector>

namespace vibe::operating {

constexpr int kJointCount = 7;  ///< length of arrays indexed by DriveJoint
/// In the order of StepInput.
enum DriveJoint : int { Insertion, Rotation, TipUpDown, TipLeftRight, HelixAdvance, HelixRotation, NeedleDriver };
using Joints = std::array<double, kJointCount>;  ///< [m] or [rad]

/// Names in the URDF and in messages.
const std::array<std::string, kJointCount>& driveJointNames();

/// Numbers of keys, those of Qt::Key, so that a window of Qt passes on what it gets: letters and digits are their
/// capital characters, and these are the others that drive or are shown.
namespace keys {
constexpr int kSpace = ' ', kEscape = 0x01000000, kShift = 0x01000020;                        ///< as Qt::Key_Space etc.
constexpr int kLeft = 0x01000012, kUp = 0x01000013, kRight = 0x01000014, kDown = 0x01000015;  ///< arrows
}  // namespace keys

/// Factor of the speed of keys: DriveSpeeds.
enum class DriveGear { Slow, Normal, Fast };

/// What a key does.
struct KeyBinding {
  /// What `index` and `sign` of a binding mean.
  enum class Kind {
    Joint,    ///< moves the joint `index` in the direction `sign` while it is held
    Button,   ///< presses the button `index` of scope/buttons
    Gear,     ///< chooses the speed `index` from now on
    SlowDown  ///< the slow speed while it is held
  };
  int key;    ///< number of the key
  Kind kind;  ///< joint, button or speed
  int index;  ///< DriveJoint, number in scope/buttons, or DriveGear; 0 for SlowDown
  int sign;   ///< 1 or -1 of a joint; 0 otherwise
};

/// All keys that drive. A key occurs once. Single letters, digits, arrows, space and Shift only: shortcuts of rviz with
/// Ctrl and Alt keep their meaning.
const std::vector<KeyBinding>& keyBindings();
/// Null for a key that does not drive.
const KeyBinding* findBinding(int key);

/// A line of the table of keys that is shown to the player.
struct KeyRow {
  struct Cap {
    int key;            ///< 0: only a label, such as "wheel"
    std::string label;  ///< on the key
  };
  std::vector<Cap> caps;    ///< the keys, in the order in which they are drawn
  std::string text;         ///< what they do, in the same order
  bool ends_group = false;  ///< a gap follows
};
/// All rows in the order of the table; some keys are those of the tool, not of the drive: next view, help, leave.
const std::vector<KeyRow>& keyRows();

/// Where a player stands.
struct DriveSituation {
  Joints joints{};       ///< as they are now [m] or [rad]
  double closed = 0;     ///< upper limit of the needle driver [m]
  bool gas_on = false;   ///< the insufflator's button is down
  double pressure = 0;   ///< gauge, of the gas [Pa]
  bool touches = false;  ///< the tool touches tissue
  bool holds = false;    ///< the helix holds tissue
  /// There is a needle with a thread; it is on the arm, or else the exchange holds it.
  bool needle_loaded = true, needle_on_arm = true;
  unsigned marks = 0;        ///< particles of the wall that are marked or worse
  unsigned set_bites = 0;    ///< of the session; the steps are those of the first set
  unsigned sets_tagged = 0;  ///< with a T-tag, not cinched
  unsigned sets_done = 0;    ///< cinched, or with a thread that is loose or broken
};

/// The next thing to do, in the order of the first set of sutures.
struct FirstStep {
  int number = 0;    ///< from 1
  std::string text;  ///< one sentence with the key to press
};
constexpr int kFirstSteps = 12;  ///< numbers of FirstStep
/// What to do next in a situation.
FirstStep firstStep(const DriveSituation& now);

}  // namespace vibe::operating
