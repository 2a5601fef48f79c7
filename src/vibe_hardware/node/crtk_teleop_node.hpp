#pragma once

#include <array>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include <diagnostic_updater/diagnostic_updater.h>
#include <geometry_msgs/PoseStamped.h>
#include <ros/ros.h>
#include <sensor_msgs/JointState.h>
#include <sensor_msgs/Joy.h>
#include <vibe_msgs/HapticParameters.h>
#include <vibe_msgs/OperatingState.h>

#include "arm_watch.hpp"
#include "hardware_messages.hpp"
#include "vibe_hardware/crtk/teleop.hpp"

namespace vibe::hardware {

/// Private parameters of crtk_teleop.
struct CrtkParameters {
  std::string mapping = "package://vibe_hardware/config/arms/touch.yaml";
  std::string arm = "arm";  ///< namespace of the arm, relative or absolute
};

/// @throws Error for a parameter that is unknown or wrong
CrtkParameters readCrtkParameters(const ros::NodeHandle& private_handle);

/// An arm with a CRTK interface as topics of the scope: docs/interfaces.md. All work is done in the callbacks of one
/// thread.
class CrtkTeleopNode {
 public:
  /// @throws Error for a wrong mapping or URDF
  CrtkTeleopNode(ros::NodeHandle handle, const CrtkParameters& parameters);
  /// At the end, when no callback runs any more: leaves the arm without force and the buttons released.
  void release();

 private:
  CrtkParameters parameters_;
  ToolLimits limits_;
  TeleopMapping mapping_;
  ArmWatch watch_;
  TeleopState state_;
  TeleopInput input_;

  bool scope_known_ = false, suturing_device_known_ = false;
  bool arm_ready_ = true;  // an arm without operating_state may be used
  std::string arm_state_;
  double last_buttons_ = -1e9, last_joints_ = -1e9;  // published [s]
  std::array<std::uint8_t, kButtonCount> sent_buttons_{};
  std::array<double, kButtonCount> tapped_{};  // a tap counts until then [s]

  ros::Publisher force_, scope_, suturing_device_, button_publisher_, absolute_, gravity_;
  std::vector<ros::Subscriber> subscribers_;
  std::vector<std::pair<std::size_t, ros::Subscriber>> pressing_;  // buttons, and who presses them
  diagnostic_updater::Updater updater_;
  ros::WallTimer timer_;

  void advertise(ros::NodeHandle& handle);
  void subscribe(ros::NodeHandle& handle);
  void listenToButton(
      ros::NodeHandle& handle, const ArmButton& button, std::function<void(bool)> pressed,
      std::function<void()> tapped = [] {});
  std::string nameOf(const std::string& topic) const;

  void onPose(const geometry_msgs::PoseStamped& message);
  void onArmJoints(const sensor_msgs::JointState& message);
  void takeSample(const std_msgs::Header& header, ArmSample sample);
  void onGripper(const sensor_msgs::JointState& message);
  void onState(const vibe_msgs::OperatingState& message);
  void onScope(const sensor_msgs::JointState& message);
  void onSuturingDevice(const sensor_msgs::JointState& message);
  void onParameters(const vibe_msgs::HapticParameters& message);
  void tick(const ros::WallTimerEvent& event);
  void advance(double now);
  void publishForce(const TeleopOutput& output, const ros::Time& stamp);
  void publishCommands(const TeleopOutput& output, double now, const ros::Time& stamp);
  void fillDiagnostics(diagnostic_updater::DiagnosticStatusWrapper& status);
};

}  // namespace vibe::hardware
