#pragma once

#include <cstdint>

#include <geometry_msgs/PoseStamped.h>
#include <geometry_msgs/TwistStamped.h>
#include <geometry_msgs/WrenchStamped.h>
#include <sensor_msgs/JointState.h>
#include <std_msgs/Float64MultiArray.h>
#include <vibe_msgs/HapticParameters.h>
#include <vibe_msgs/OperatingState.h>
#include <vibe_msgs/ToolContacts.h>
#include <Eigen/Geometry>

#include "input/input_sample.hpp"
#include "simulation/timed_simulation.hpp"
#include "vibe_core/haptics/tool_impedance.hpp"
#include "vibe_core/model/model.hpp"
#include "vibe_core/simulation/tool_queries.hpp"
#include "vibe_core/state/state.hpp"

// Where the tool is and what it feels; scope and suturing device as robots of the CRTK convention.

namespace vibe::sim {

/// Positions of all inputs where the tool really is, displaced where a scope gives way [m], [rad].
JointArray toolJoints(const State& state);

/// Position, velocity and effort of the scope's joints. The effort is that of the hand, mean over the step.
/// @param velocity  of all joints, mean over the step [m/s], [rad/s]
sensor_msgs::JointState makeMeasuredScope(const State& state, const JointArray& velocity, std::int64_t stamp);
/// The same of the suturing device, whose joints have no effort.
sensor_msgs::JointState makeMeasuredSuturingDevice(const State& state, const JointArray& velocity, std::int64_t stamp);

/// Velocity of the tip between two of its poses in the world: linear [m/s] and angular [rad/s], mean over the time.
/// @param seconds  from one to the other, above 0
geometry_msgs::TwistStamped makeTipTwist(const Eigen::Isometry3d& before, const Eigen::Isometry3d& now, double seconds,
                                         std::int64_t stamp);

/// @param present  there is such an arm in the scene
vibe_msgs::OperatingState makeOperatingState(bool present, bool paused, bool busy, std::int64_t stamp);

/// Six rows and four columns, row by row.
std_msgs::Float64MultiArray makeJacobian(const TipJacobian& jacobian);

/// Position: the place; x axis: normal of the wall, to the side of the scope.
geometry_msgs::PoseStamped makeWallPose(const WallSight& sight, std::int64_t stamp);

/// All joints that the tool really has, for robot_state_publisher, which works out those that mimic them: those of its
/// inputs, displaced where a scope gives way, then those of the shaft, then those that are only drawn (drawnJoints()).
/// @param model  with a tool
sensor_msgs::JointState makeJointState(const Model& model, const State& state, std::int64_t stamp);
/// Where the hand holds the scope's joints, and with what effort.
sensor_msgs::JointState makeHandJoints(const State& state, std::int64_t stamp);
geometry_msgs::WrenchStamped makeWrench(const State& state, std::int64_t stamp);
/// @param force_limit  at which the helix loses what it holds [N]; infinite where it holds nothing
vibe_msgs::HapticParameters makeHapticParameters(const ToolImpedance& response, double force_limit, std::int64_t stamp);
/// Nothing is touched any longer.
vibe_msgs::HapticParameters makeHapticRelease(std::int64_t stamp);

/// Where the tool touches and holds the wall in the last step. @param simulation  of a scene with a tool
vibe_msgs::ToolContacts makeToolContacts(const TimedSimulation& simulation);

}  // namespace vibe::sim
