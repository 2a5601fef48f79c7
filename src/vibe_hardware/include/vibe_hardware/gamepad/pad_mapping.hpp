#pragma once
#include <array>
#include <string>
#include <vector>

#include "vibe_core/input/step_input.hpp"
#include "vibe_core/tool/tool_model.hpp"

namespace vibe::hardware {

/// Range and greatest speed of the seven joints, from the URDF.
using ToolLimits = std::array<JointLimits, kJointCount>;

/// The limits of the tool of a URDF file or package:// address. @throws Error as ToolModel::fromUrdf()
ToolLimits loadToolLimits(const std::string& urdf_address);

/// What moves a joint.
struct JointMapping {
  /// Which kind of control of the pad moves the joint.
  enum class Control {
    None,    ///< nothing: the joint stays where it is
    Axis,    ///< one axis that rests in the middle of its range
    Axes,    ///< two axes that rest at their minimum, such as triggers: the first forwards, the second backwards
    Buttons  ///< two buttons: the first forwards, the second backwards
  };
  /// What the deflection of the control, -1 to 1, means.
  enum class Mode {
    Rate,     ///< the deflection is a speed
    Position  ///< the deflection is a position
  };
  Control control = Control::None;  ///< kind; None: all else is without meaning
  int forward = -1;                 ///< event code of the axis, or of the first of two
  int backward = -1;                ///< event code of the second of two
  Mode mode = Mode::Rate;           ///< rate or position
  double rate = 0;                  ///< rate mode: speed at full deflection [m/s], [rad/s]
  double low = 0;                   ///< position mode: joint at deflection -1 [m], [rad]
  double high = 0;                  ///< position mode: joint at deflection 1 [m], [rad]
  double dead_zone = 0;             ///< deflection below which the control counts as centred, 0 to 0.9
  double exponent = 1;     ///< of the response beyond the dead zone, 0.2 to 5; 1: linear, 2: fine near the centre
  bool reversed = false;   ///< the deflection counts with the opposite sign
  double full_effort = 0;  ///< position mode: effort shown by the device's greatest force [N], [N m]; 0: no spring
};

/// What presses a button of the simulator.
struct ButtonMapping {
  int code = -1;        ///< event code; -1: nothing
  bool toggle = false;  ///< every press switches, instead of holding
};

/// How strongly the pad shakes.
struct FeedbackMapping {
  double rumble_force = 5;  ///< force on the tool at which the strong motor runs at its greatest [N]; 0: no rumble
};

/// Which controls of a pad the numbers of a sensor_msgs/Joy are: event codes in the order of its axes and buttons. The
/// default is what joy_node publishes of a pad with two sticks, two triggers that are axes, and a cross.
struct JoyNames {
  std::vector<int> axes, buttons;  ///< event codes: ABS_X, ... and BTN_SOUTH, ...
  JoyNames();                      ///< the default
};

/// How axes and buttons of a pad become joints and buttons of the simulator. Format: docs/tutorials/drive_by_hand.md.
struct PadMapping {
  std::string name;                                 ///< for messages
  std::array<JointMapping, kJointCount> joints;     ///< by vibe::Joint
  std::array<ButtonMapping, kButtonCount> buttons;  ///< by vibe::Button
  FeedbackMapping feedback;                         ///< of the motors
  JoyNames joy;                                     ///< for pads that come as a topic
};

/// Names of the joints and buttons that nothing in the mapping moves or presses, in their order.
std::vector<std::string> unreachable(const PadMapping& mapping);

/// Reads a mapping file.
/// @throws Error "file:line: key: what is wrong; remedy" for an unknown or repeated key, a value of another type or
///         unit, one out of range (the speeds and ranges of the URDF), and a control that is used twice
PadMapping loadPadMapping(const std::string& file, const ToolLimits& limits);
/// The same from text. @param place  name used in errors
PadMapping parsePadMapping(const std::string& text, const std::string& place, const ToolLimits& limits);

}  // namespace vibe::hardware
