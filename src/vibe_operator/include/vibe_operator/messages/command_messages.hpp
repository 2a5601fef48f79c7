#pragma once

#include <string>

#include <sensor_msgs/JointState.h>
#include <vibe_msgs/ProcedureState.h>
#include <vibe_msgs/TissuePullState.h>
#include <Eigen/Core>

#include "vibe_operator/drive/drive_keys.hpp"
#include "vibe_operator/drive/scope_drive.hpp"

namespace vibe::operating {

/// Limits of the seven joints from a URDF. @return empty, or one sentence that says what is wrong with it
std::string readJointLimits(const std::string& urdf, JointLimits& limits);

/// The seven joints of joint_states, matched by name. @return false if one is missing or not finite
bool readJoints(const sensor_msgs::JointState& message, Joints& joints);

/// For scope/servo_jp: the first four joints.
sensor_msgs::JointState scopeMessage(const Joints& joints, const ros::Time& stamp);
/// For suturing_device/input/joint_states: the other three.
sensor_msgs::JointState suturingDeviceMessage(const Joints& joints, const ros::Time& stamp);

/// Whether the state did not follow from the one before by steps: a reset, a snapshot or another scene was loaded.
bool isOtherSession(const vibe_msgs::ProcedureState& before, const vibe_msgs::ProcedureState& now);

/// What the state tells about the first steps; joints and buttons are not in it.
DriveSituation situationOf(const vibe_msgs::ProcedureState& state);

/// The pull spring after a step.
struct PullState {
  int particle = -1;                                   ///< -1: it is released
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< of the held patch [m]
  Eigen::Vector3d target = Eigen::Vector3d::Zero();    ///< after the simulator's limits [m]
  Eigen::Vector3d force = Eigen::Vector3d::Zero();     ///< of the spring on the tissue [N]
};

/// Checks and reads a message.
/// @return empty, and the state is set; otherwise one sentence that says what is wrong
std::string readPullState(const vibe_msgs::TissuePullState& message, PullState& state);

}  // namespace vibe::operating
