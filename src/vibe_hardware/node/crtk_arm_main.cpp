// crtk_arm: an arm with a CRTK interface without hardware, held by a hand that sways: to try and test crtk_teleop and
// other CRTK clients.

#include <geometry_msgs/PoseStamped.h>
#include <geometry_msgs/TwistStamped.h>
#include <geometry_msgs/WrenchStamped.h>
#include <ros/ros.h>
#include <sensor_msgs/JointState.h>
#include <sensor_msgs/Joy.h>
#include <std_msgs/Bool.h>
#include <vibe_msgs/OperatingState.h>
#include <vibe_msgs/StateCommand.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "vibe_hardware/emulator/emulated_arm.hpp"
#include "vibe_ros_utils/parameter_reader.hpp"
#include "vibe_ros_utils/startup.hpp"

namespace {

using namespace vibe::hardware;

constexpr double kRate = 1000;        // of measurements [Hz]
constexpr int kFineSteps = 5;         // of the mechanics between two measurements
constexpr double kLargestForce = 10;  // what its motors make [N]
constexpr std::uint32_t kQueue = 10;
// Joints, of an arm that measures only those: away from the person, up, to the left, about the way away.
const char* const kReach = "reach";
const char* const kLift = "lift";
const char* const kSide = "side";
const char* const kRoll = "roll";

struct Parameters {
  double sway = 0;         // of the hand away from the person and back [m]
  double frequency = 0.5;  // [Hz]
  double start = 2;        // when the sway begins [s]
  double gripper = 0.5;    // its angle [rad]
  bool joints = false;     // it measures only its joints
};

Parameters readParameters(const ros::NodeHandle& handle) {
  vibe::ros_utils::ParameterReader reader(handle);
  Parameters p;
  reader.read("sway", p.sway, -0.5, 0.5, "m");
  reader.read("frequency", p.frequency, 0, 20, "Hz");
  reader.read("start", p.start, 0, 1000, "s");
  reader.read("gripper", p.gripper, -7, 7, "rad");
  reader.read("joints", p.joints);
  reader.finish();
  return p;
}

/// Its base has x to the right, y up and z to the person, as that of a Touch.
class Arm {
 public:
  Arm(ros::NodeHandle& handle, const Parameters& parameters) : parameters_(parameters) {
    if (parameters.joints) {
      joints_ = handle.advertise<sensor_msgs::JointState>("measured_js", kQueue);
    } else {
      pose_ = handle.advertise<geometry_msgs::PoseStamped>("measured_cp", kQueue);
      twist_ = handle.advertise<geometry_msgs::TwistStamped>("measured_cv", kQueue);
    }
    gripper_ = handle.advertise<sensor_msgs::JointState>("gripper/measured_js", kQueue);
    operating_ = handle.advertise<vibe_msgs::OperatingState>("operating_state", kQueue, true);
    for (const char* name : {"button1", "button2"}) {
      buttons_.push_back(handle.advertise<sensor_msgs::Joy>(name, kQueue, true));
      sensor_msgs::Joy up;
      up.header.stamp = ros::Time::now();
      up.buttons.push_back(0);
      buttons_.back().publish(up);
    }
    const ros::TransportHints hints = ros::TransportHints().tcpNoDelay();
    subscribers_ = {handle.subscribe("servo_cf", kQueue, &Arm::onForce, this, hints),
                    handle.subscribe("body/servo_cf", kQueue, &Arm::onBodyForce, this, hints),
                    handle.subscribe("body/set_cf_orientation_absolute", kQueue, &Arm::onAbsolute, this, hints),
                    handle.subscribe("servo_jf", kQueue, &Arm::onEfforts, this, hints),
                    handle.subscribe("state_command", kQueue, &Arm::onCommand, this, hints)};
    publishState("ENABLED");
    timer_ = handle.createWallTimer(ros::WallDuration(1 / kRate), &Arm::tick, this);
  }

 private:
  Parameters parameters_;
  EmulatedArmConfig config_;
  EmulatedArmState state_;
  Eigen::Vector3d force_ = Eigen::Vector3d::Zero(), torque_ = Eigen::Vector3d::Zero();  // in the base
  bool absolute_ = false;
  double time_ = 0;
  ros::WallTime begin_ = ros::WallTime::now();
  std::string operating_state_;
  ros::Publisher pose_, twist_, joints_, gripper_, operating_;
  std::vector<ros::Publisher> buttons_;
  std::vector<ros::Subscriber> subscribers_;
  ros::WallTimer timer_;

  void take(const geometry_msgs::Wrench& wrench, const Eigen::Quaterniond& frame) {
    const Eigen::Vector3d force(wrench.force.x, wrench.force.y, wrench.force.z);
    const Eigen::Vector3d torque(wrench.torque.x, wrench.torque.y, wrench.torque.z);
    if (!force.allFinite() || !torque.allFinite()) return;
    force_ = frame * force * std::min(1.0, kLargestForce / std::max(force.norm(), 1e-9));
    torque_ = frame * torque;
  }
  void onForce(const geometry_msgs::WrenchStamped& m) { take(m.wrench, Eigen::Quaterniond::Identity()); }
  void onBodyForce(const geometry_msgs::WrenchStamped& m) {
    take(m.wrench, absolute_ ? Eigen::Quaterniond::Identity() : orientationOf(state_));
  }
  void onEfforts(const sensor_msgs::JointState& m) {
    geometry_msgs::Wrench wrench;
    for (std::size_t i = 0; i < m.name.size() && i < m.effort.size(); ++i) {
      if (m.name[i] == kReach) wrench.force.z = -m.effort[i];
      if (m.name[i] == kLift) wrench.force.y = m.effort[i];
      if (m.name[i] == kSide) wrench.force.x = -m.effort[i];
      if (m.name[i] == kRoll) wrench.torque.z = -m.effort[i];
    }
    take(wrench, Eigen::Quaterniond::Identity());
  }
  void onAbsolute(const std_msgs::Bool& message) { absolute_ = message.data != 0; }

  void onCommand(const vibe_msgs::StateCommand& message) {
    if (message.string == "disable") publishState("DISABLED");
    if (message.string == "pause" && operating_state_ == "ENABLED") publishState("PAUSED");
    if (message.string == "enable" || (message.string == "resume" && operating_state_ == "PAUSED"))
      publishState("ENABLED");
  }

  void publishState(const std::string& state) {
    operating_state_ = state;
    vibe_msgs::OperatingState message;
    message.header.stamp = ros::Time::now();
    message.state = state;
    message.is_homed = true;
    operating_.publish(message);
  }

  void tick(const ros::WallTimerEvent&) {
    const double now = (ros::WallTime::now() - begin_).toSec();
    if (now - time_ > 1) time_ = now - 1;  // after a stall
    const bool powered = operating_state_ == "ENABLED";
    const Eigen::Vector3d none = Eigen::Vector3d::Zero();
    while (time_ + 1 / kRate <= now) {
      HandIntent intent;
      const double phase = 2 * M_PI * parameters_.frequency * std::max(0.0, time_ - parameters_.start);
      intent.position.z() = -0.5 * parameters_.sway * (1 - std::cos(phase));  // away from the person
      for (int i = 0; i < kFineSteps; ++i)
        stepArm(config_, 1 / kRate / kFineSteps, powered ? force_ : none, powered ? torque_ : none, intent, state_);
      time_ += 1 / kRate;
    }
    publishMotion();
  }

  void publishMotion() {
    std_msgs::Header header;
    header.stamp = ros::Time::now();
    header.frame_id = "arm_base";
    parameters_.joints ? publishJoints(header) : publishPose(header);
    sensor_msgs::JointState gripper;
    gripper.header = header;
    gripper.name.emplace_back("gripper");
    gripper.position.push_back(parameters_.gripper);
    gripper_.publish(gripper);
  }

  void publishJoints(const std_msgs::Header& header) {
    sensor_msgs::JointState joints;
    joints.header = header;
    joints.name = {kReach, kLift, kSide, kRoll};
    joints.position = {-state_.position.z(), state_.position.y(), -state_.position.x(), -state_.turn.z()};
    joints.velocity = {-state_.velocity.z(), state_.velocity.y(), -state_.velocity.x(), -state_.spin.z()};
    joints_.publish(joints);
  }

  void publishPose(const std_msgs::Header& header) {
    geometry_msgs::PoseStamped pose;
    pose.header = header;
    pose.pose.position.x = state_.position.x();
    pose.pose.position.y = state_.position.y();
    pose.pose.position.z = state_.position.z();
    const Eigen::Quaterniond q = orientationOf(state_);
    pose.pose.orientation.x = q.x();
    pose.pose.orientation.y = q.y();
    pose.pose.orientation.z = q.z();
    pose.pose.orientation.w = q.w();
    pose_.publish(pose);
    geometry_msgs::TwistStamped twist;
    twist.header = header;
    twist.twist.linear.x = state_.velocity.x();
    twist.twist.linear.y = state_.velocity.y();
    twist.twist.linear.z = state_.velocity.z();
    twist.twist.angular.x = state_.spin.x();
    twist.twist.angular.y = state_.spin.y();
    twist.twist.angular.z = state_.spin.z();
    twist_.publish(twist);
  }
};

}  // namespace

int main(int argc, char** argv) {
  return vibe::ros_utils::runNode(argc, argv, "arm", [] {
    ros::NodeHandle handle("arm");
    Arm arm(handle, readParameters(ros::NodeHandle("~")));
    ros::spin();
  });
}
