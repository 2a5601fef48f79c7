#pragma once

#include <memory>
#include <optional>
#include <string>

#include <diagnostic_updater/diagnostic_updater.h>
#include <geometry_msgs/WrenchStamped.h>
#include <ros/node_handle.h>
#include <ros/ros.h>
#include <sensor_msgs/JointState.h>
#include <vibe_msgs/HapticParameters.h>
#include <vibe_msgs/ProcedureEvent.h>

#include "hardware_messages.hpp"
#include "vibe_hardware/gamepad/pad_drive.hpp"
#include "vibe_hardware/gamepad/pad_feedback.hpp"
#include "vibe_hardware/gamepad/pad_mapping.hpp"
#include "vibe_hardware/gamepad/pad_recording.hpp"
#include "vibe_hardware/gamepad/pad_source.hpp"

namespace vibe::hardware {

/// Private parameters of gamepad_node.
struct GamepadParameters {
  std::string mapping = "package://vibe_hardware/config/gamepads/two_stick.yaml";
  std::string pad;     ///< path, or part of the name or phys; empty: the first gamepad
  std::string joy;     ///< topic of sensor_msgs/Joy to read instead of a device; empty: none
  std::string replay;  ///< a recorded pad session to play instead; empty: none
  std::string record;  ///< where to record the pad; empty: nowhere
  double rate = 100;   ///< of the published joints [Hz]
};

/// @throws Error for a parameter that is unknown or wrong
GamepadParameters readGamepadParameters(const ros::NodeHandle& private_handle);

/// Limits of the tool from the parameter robot_description, or from the package's URDF if it is not set.
ToolLimits toolLimitsOf(const ros::NodeHandle& handle);

/// The pad, topic or recording that the parameters ask for. @throws Error for a recording that cannot be read
PadLink makePadLink(const ros::NodeHandle& handle, const GamepadParameters& parameters, const JoyNames& names);

/// A gamepad as topics: docs/interfaces.md. All work is done in the callbacks of one thread.
class GamepadNode {
 public:
  /// @throws Error for a wrong mapping, recording or URDF, and if the pad cannot be recorded where the parameters say
  GamepadNode(ros::NodeHandle handle, const GamepadParameters& parameters);

 private:
  GamepadParameters parameters_;
  ToolLimits limits_;
  PadMapping mapping_;
  PadFeedback feedback_;
  std::unique_ptr<PadRecorder> recorder_;  // outlives the pad that calls it
  PadLink link_;

  std::optional<std::array<double, kJointCount>> measured_;  // joints of the simulator
  std::optional<DriveState> drive_;                          // from the first pad on
  std::uint64_t drops_told_ = 0;
  std::uint64_t published_ = 0;
  double last_tick_ = 0;        // steady time [s]
  double last_buttons_ = -1e9;  // published [s]
  double last_hint_ = -1e9;     // [s]
  std::string hint_;
  std::array<std::uint8_t, kButtonCount> sent_buttons_{};
  StampSource joint_stamps_, button_stamps_;

  ros::Publisher scope_, suturing_device_, buttons_;
  std::vector<ros::Subscriber> subscribers_;
  diagnostic_updater::Updater updater_;
  std::uint64_t events_before_ = 0;  // at the last diagnostics
  ros::WallTimer timer_;

  void subscribe(ros::NodeHandle& handle);
  void tick(const ros::WallTimerEvent& event);
  bool followPad(double now);
  void padFound();
  void padGone();
  void startRecording();
  void drive(double now, double dt);
  void hintAt(const std::string& sentence, double now);
  void publish(double now);
  void publishButtons(double now);
  void fillDiagnostics(diagnostic_updater::DiagnosticStatusWrapper& status);

  void onJoints(const sensor_msgs::JointState& message);
  void onForce(const geometry_msgs::WrenchStamped& message);
  void onEvent(const vibe_msgs::ProcedureEvent& message);
  void onParameters(const vibe_msgs::HapticParameters& message);
};

}  // namespace vibe::hardware
