#pragma once

#include <cstdint>

#include <geometry_msgs/PoseStamped.h>
#include <sensor_msgs/JointState.h>
#include <std_msgs/Float64MultiArray.h>
#include <vibe_msgs/OperatingState.h>

#include "input/input_interpreter.hpp"
#include "vibe_core/simulation/tip_motion.hpp"
#include "vibe_core/state/state.hpp"

// Scope and suturing device as robots of the CRTK convention: messages about where they really are.

namespace vibe::sim {

/// Positions of all inputs where the tool really is, displaced where a scope gives way [m], [rad].
JointArray toolJoints(const State& state);

/// Position, velocity and effort of the scope's joints. The effort is that of the hand, mean over the step.
/// @param velocity  of all joints, mean over the step [m/s], [rad/s]
sensor_msgs::JointState makeMeasuredScope(const State& state, const JointArray& velocity, std::int64_t stamp);
/// The same of the suturing device, whose joints have no effort.
sensor_msgs::JointState makeMeasuredOverstitch(const State& state, const JointArray& velocity, std::int64_t stamp);

/// @param present  there is such an arm in the scene
vibe_msgs::OperatingState makeOperatingState(bool present, bool paused, bool busy, std::int64_t stamp);

/// Six rows and four columns, row by row.
std_msgs::Float64MultiArray makeJacobian(const TipJacobian& jacobian);

/// Position: the place; x axis: normal of the wall, to the side of the scope.
geometry_msgs::PoseStamped makeWallPose(const WallSight& sight, std::int64_t stamp);

}  // namespace vibe::sim
