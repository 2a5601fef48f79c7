#pragma once
#include <geometry_msgs/PoseStamped.h>
#include <geometry_msgs/TwistStamped.h>
#include <sensor_msgs/JointState.h>
#include <sensor_msgs/Joy.h>
#include <vibe_msgs/StepInput.h>
#include <vibe_msgs/TissuePull.h>
#include <vibe_msgs/TissuePullState.h>

#include <cstdint>

#include "input/input_sample.hpp"
#include "vibe_core/state/state.hpp"

// Inputs of a step: as the messages of devices and clients, as what was applied, and the pull.

namespace vibe::sim {

/// Some of the joints of a StepInput, one after the other.
struct JointRange {
  int first;
  int count;
};

JointRange jointsOf(InputChannel channel);

/// Positions of some joints with their names, in the frame of the scope's base.
sensor_msgs::JointState makeJoints(const JointArray& joints, JointRange range, std::int64_t stamp);

/// What kind of joint message it is: measured by a device, where stamp 0 says "invalid", or commanded by a client.
enum class JointSource { Measured, Commanded };

/// Joint positions by name, in any order; all joints of the channel and no others. Commands may leave the names out and
/// give the positions in the order of vibe::Joint.
InputSample readJoints(const sensor_msgs::JointState& message, InputChannel channel, JointSource source);

/// The goal of a move: the same as a command.
InputSample readMove(const sensor_msgs::JointState& message, InputChannel channel);

/// Buttons by position; more than kButtonCount or fewer is an error, as is a value other than 0 or 1.
InputSample readButtons(const sensor_msgs::Joy& message);

/// Pose of scope_tip in the frame world or scope_base; without a frame, as CRTK clients send it, in world.
InputSample readTipTarget(const geometry_msgs::PoseStamped& message);

/// The goal of a move: the same.
InputSample readTipMove(const geometry_msgs::PoseStamped& message);

/// Velocity of scope_tip: linear [m/s], of its origin, and angular [rad/s], along the axes of the frame world or
/// scope_base; without a frame, in world.
InputSample readTipVelocity(const geometry_msgs::TwistStamped& message);

/// A pull at the tissue, with its target in the frame world or stomach, which are the same.
/// @throws Error with one sentence if the message cannot be used
InputSample readPull(const vibe_msgs::TissuePull& message);

sensor_msgs::Joy makeButtons(const StepInput& input, std::int64_t stamp);

/// Without run and hashes.
vibe_msgs::StepInput makeStepInput(const StepInput& input, std::int64_t step, std::int64_t stamp);

/// The pull spring after a step. Without a pull the particle is -1 and everything else is 0.
vibe_msgs::TissuePullState makePullState(const State& state, std::int64_t stamp);

}  // namespace vibe::sim
