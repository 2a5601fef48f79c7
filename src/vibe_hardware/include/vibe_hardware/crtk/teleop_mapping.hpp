#pragma once
#include <Eigen/Core>
#include <array>
#include <optional>
#include <string>
#include <vector>

#include "vibe_core/input/step_input.hpp"
#include "vibe_hardware/crtk/port_passivity.hpp"
#include "vibe_hardware/gamepad/pad_mapping.hpp"

namespace vibe::hardware {

/// Coordinates of the hand that holds the arm, along and about the axes of its own frame: x away from the person, y to
/// the left, z up. One of the angles is the twist about the stylus, the other two are its swing (HandRotation). Of an
/// arm that measures only its joints, the coordinates are those of TeleopMapping::arm_joints instead.
enum HandCoordinate : int { HandX, HandY, HandZ, HandRoll, HandPitch, HandYaw };
constexpr int kHandCoordinates = 6;  ///< length of arrays indexed by HandCoordinate

/// How a coordinate of the hand moves a joint of the scope or of its suturing device.
struct HandJoint {
  int coordinate = -1;  ///< HandCoordinate, or index in arm_joints; -1: the joint stays where it is
  double scale = 0;     ///< joint per coordinate [m/m], [m/rad], [rad/m] or [rad/rad], not 0; its sign is the direction
  PortConfig port;      ///< of the coordinate; with a joint of the suturing device there are no forces
};

/// A button of sensor_msgs/Joy on some topic, as CRTK drivers publish pedals and buttons.
struct ArmButton {
  /// When a button of the procedure can be pressed.
  enum class While {
    Always,  ///< whatever the arm moves
    Scope,   ///< the arm moves the scope
    Device   ///< the arm moves the suturing device
  };
  std::string topic;             ///< relative to the arm, or absolute; empty: none
  int index = 0;                 ///< in Joy::buttons
  bool reversed = false;         ///< of clutch and device: it acts while it is up
  bool toggle = false;           ///< of the procedure: every press switches, instead of holding
  While during = While::Always;  ///< of the procedure
};

/// What the gripper of the arm does: its angle sets a joint of the suturing device, or closing it presses a button.
struct ArmGripper {
  std::string topic = "gripper/measured_js";  ///< sensor_msgs/JointState, relative to the arm or absolute
  int joint = -1;                             ///< HelixAdvance to NeedleDriver; -1: none
  int button = -1;                            ///< vibe::Button; -1: none. One of the two is not -1
  double closed = 0, open = 1;                ///< angles of the gripper [rad], different
  double at_closed = 0, at_open = 0;          ///< positions of the joint there [m], [rad]
};

/// Which way the forces go back.
enum class ForceFrame {
  Base,  ///< the wrench has the axes of the arm's base (frame_id of measured_cp)
  Body   ///< the wrench has the axes of the moving frame
};

/// How an arm with a CRTK interface drives the scope. Format: docs/hardware.md, "CRTK arms".
struct TeleopMapping {
  std::string name;                                    ///< of the arm, for messages
  std::string pose_topic = "measured_cp";              ///< geometry_msgs/PoseStamped, relative to the arm or absolute
  std::vector<std::string> arm_joints;                 ///< of measured_js; empty: the arm measures measured_cp
  Eigen::Matrix3d hand = Eigen::Matrix3d::Identity();  ///< columns: unit vectors of the hand's axes in the arm's base
  int twist = 0;                                       ///< number of the hand's axis about which the stylus twists
  Eigen::Vector3d stylus = Eigen::Vector3d::UnitX();   ///< its own axis in the moving frame; unit vector
  /// By vibe::Joint. Each coordinate moves at most one joint of the scope and one of the suturing device.
  std::array<HandJoint, kJointCount> joints;
  ArmButton device;  ///< while it is pressed, the arm moves the suturing device and the scope stays; no topic: never
  bool device_only = false;  ///< the arm moves the suturing device all the time, and no joint of the scope
  std::array<ArmButton, kButtonCount> buttons;  ///< by vibe::Button; an empty topic: nothing presses that button
  ArmButton clutch;                             ///< while it is pressed, the scope stays and the arm is free
  std::optional<ArmGripper> gripper;            ///< empty: the gripper moves nothing
  double force_scale = 1;                       ///< of the forces of the tissue; 0: no forces
  std::string force_topic = "servo_cf";         ///< relative to the arm; with arm_joints servo_jf
  ForceFrame force_frame = ForceFrame::Base;    ///< which axes the driver of the arm expects
  double timeout = 0.1;                         ///< without a measurement after which the arm lets go of the scope [s]
};

/// Whether anything presses a button of the procedure.
bool pressesButtons(const TeleopMapping& mapping);
/// Names of the joints and buttons that nothing in the mapping moves or presses, in their order.
std::vector<std::string> unreachable(const TeleopMapping& mapping);

/// Reads a mapping file.
/// @throws Error "file:line: key: what is wrong; remedy"
TeleopMapping loadTeleopMapping(const std::string& file, const ToolLimits& limits);
/// The same from text. @param place  name used in errors
TeleopMapping parseTeleopMapping(const std::string& text, const std::string& place, const ToolLimits& limits);

}  // namespace vibe::hardware
