#pragma once

#include <string>

#include <geometry_msgs/PoseStamped.h>
#include <geometry_msgs/TransformStamped.h>
#include <geometry_msgs/WrenchStamped.h>
#include <sensor_msgs/JointState.h>
#include <sensor_msgs/Joy.h>
#include <std_msgs/String.h>
#include <vibe_msgs/HapticParameters.h>
#include <vibe_msgs/ProcedureEvent.h>
#include <vibe_msgs/StageTime.h>
#include <vibe_msgs/StepInput.h>
#include <vibe_msgs/TissueTopology.h>

#include "input/input_queue.hpp"
#include "vibe_core/common/step_timer.hpp"
#include "vibe_core/events/event.hpp"
#include "vibe_core/haptics/tool_impedance.hpp"
#include "vibe_core/input/step_input.hpp"
#include "vibe_core/model/model.hpp"
#include "vibe_core/state/state.hpp"

// Messages <-> library, without any ROS graph. Functions that read a message throw vibe::Error with one sentence if the
// message cannot be used.

namespace vibe::sim {

constexpr const char* kWorldFrame = "world";
constexpr const char* kTissueFrame = "stomach";
constexpr const char* kScopeBaseFrame = "scope_base";
constexpr const char* kScopeTipFrame = "scope_tip";

/// Whether a value has its number in a message.
template <typename Enum>
constexpr bool same(Enum ours, std::uint8_t wire) {
  return static_cast<std::uint8_t>(ours) == wire;
}

/// @param Message  geometry_msgs::Point or Vector3
template <typename Message>
Eigen::Vector3d toVector(const Message& message) {
  return {message.x, message.y, message.z};
}

/// Messages cannot carry times before 0; such a stamp becomes 0.
ros::Time toRosTime(std::int64_t nanoseconds);
std::int64_t fromRosTime(const ros::Time& time);

/// What kind of joint message it is: measured by a device, where stamp 0 says "invalid", or commanded by a client.
enum class JointSource { Measured, Commanded };

/// Joint positions by name, in any order; all joints of the channel and no others. Commands may leave the names out and
/// give the positions in the order of vibe::Joint.
InputSample readJoints(const sensor_msgs::JointState& message, InputChannel channel, JointSource source);

/// The goal of a move: the same as a command.
InputSample readMove(const sensor_msgs::JointState& message, InputChannel channel);

/// Buttons by position; more than kButtonCount or fewer is an error, as is a value other than 0 or 1.
InputSample readButtons(const sensor_msgs::Joy& message);

/// Pose of scope_tip in the frame world or scope_base.
InputSample readTipTarget(const geometry_msgs::PoseStamped& message);

sensor_msgs::JointState makeScopeJoints(const StepInput& input, std::int64_t stamp);
sensor_msgs::JointState makeOverstitchJoints(const StepInput& input, std::int64_t stamp);
sensor_msgs::Joy makeButtons(const StepInput& input, std::int64_t stamp);

/// Without run and hashes.
vibe_msgs::StepInput makeStepInput(const StepInput& input, std::int64_t step, std::int64_t stamp);
/// What a recorded step used, bit for bit.
StepInput readStepInput(const vibe_msgs::StepInput& message);

/// All joints that the tool really has, for robot_state_publisher, which works out those that mimic them: those of its
/// inputs, displaced where a scope gives way, then those of the shaft, then those that are only drawn (drawnJoints()).
/// @param model  with a tool
sensor_msgs::JointState makeJointState(const Model& model, const State& state, std::int64_t stamp);
/// Where the hand holds the scope's joints, and with what effort.
sensor_msgs::JointState makeHandJoints(const State& state, std::int64_t stamp);
geometry_msgs::PoseStamped makePose(const Eigen::Isometry3d& pose, const std::string& frame, std::int64_t stamp);
geometry_msgs::WrenchStamped makeWrench(const State& state, std::int64_t stamp);
/// @param force_limit  at which the helix loses what it holds [N]; infinite where it holds nothing
vibe_msgs::HapticParameters makeHapticParameters(const ToolImpedance& response, double force_limit, std::int64_t stamp);
/// Nothing is touched any longer.
vibe_msgs::HapticParameters makeHapticRelease(std::int64_t stamp);
geometry_msgs::TransformStamped makeTransform(const Eigen::Isometry3d& pose, const std::string& parent,
                                              const std::string& child, std::int64_t stamp);
/// The scene as a scene file that builds the same model anywhere: absolute paths, the seed in use.
std_msgs::String makeSceneText(const Scene& scene, std::uint64_t seed);
vibe_msgs::ProcedureEvent makeEvent(const Event& event, std::int64_t stamp);
/// A warning of the node itself, such as an input that it cannot use.
vibe_msgs::ProcedureEvent makeWarning(const std::string& text, std::int64_t stamp);
vibe_msgs::TissueTopology makeTopology(const Model& model, std::uint32_t revision, std::int64_t stamp);
vibe_msgs::StageTime makeStageTime(const std::string& name, const DurationHistogram& durations);

/// What the tool does to the organ at the moment: "grip", "insufflation", "contact" or "free".
const char* toolStateOf(const State& state, const StepInput& input);

}  // namespace vibe::sim
