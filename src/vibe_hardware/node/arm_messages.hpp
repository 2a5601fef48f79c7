#pragma once

#include <string>
#include <vector>

#include <geometry_msgs/PoseStamped.h>
#include <geometry_msgs/WrenchStamped.h>
#include <sensor_msgs/JointState.h>

#include "vibe_hardware/crtk/teleop.hpp"

namespace vibe::hardware {

/// What is wrong with a message of an arm. `sample` is complete but for its time if nothing is.
struct MessageFault {
  std::string what;         ///< for "A message is ignored: ..."; empty: nothing
  bool of_mapping = false;  ///< the message is right, but the mapping names what it does not have
};

/// Of measured_cp.
MessageFault readPose(const geometry_msgs::PoseStamped& message, ArmSample& sample);
/// Of measured_js. @param names  TeleopMapping::arm_joints
MessageFault readArmJoints(const sensor_msgs::JointState& message, const std::vector<std::string>& names,
                           ArmSample& sample);

/// For servo_cf. @param frame  of the arm's base
geometry_msgs::WrenchStamped makeArmForce(const TeleopOutput& output, const std::string& frame, const ros::Time& stamp);
/// For servo_jf. @param names  TeleopMapping::arm_joints
sensor_msgs::JointState makeArmEfforts(const TeleopOutput& output, const std::vector<std::string>& names,
                                       const ros::Time& stamp);

}  // namespace vibe::hardware
