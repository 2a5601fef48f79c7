#pragma once
#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <string>

#include "vibe_core/input/step_input.hpp"

namespace vibe::sim {

using JointArray = std::array<double, kJointCount>;

/// Where an input comes from. Each has its own queue, because each has its own rate.
enum class InputChannel { Scope, SuturingDevice, Buttons, Pull };
constexpr int kInputChannelCount = 4;
constexpr int kLockstepChannelCount = 3;  ///< the first ones; a pull is optional

const char* toString(InputChannel channel);

/// What a sample of the channel Scope says: joint positions, the pose that scope_tip is to reach, or its velocity.
enum class ScopeTarget { Joints, TipInWorld, TipInBase, VelocityInWorld, VelocityInBase };

/// Who has sent a sample, for sentences, and on which topic.
struct SampleSender {
  std::string topic, node;
};

/// One valid message, free of ROS. Only the values of its channel count.
struct InputSample {
  InputChannel channel = InputChannel::Scope;
  const SampleSender* sender = nullptr;  ///< outlives the sample; null: nobody in particular
  std::int64_t stamp = 0;                ///< time of the sample [ns]; 0: as soon as possible
  JointArray joints{};
  bool move = false;  ///< joints or pose are the goal of a JointMove from where the hand is; else where it is to be now
  std::array<std::uint8_t, kButtonCount> buttons{};
  ScopeTarget target = ScopeTarget::Joints;
  Eigen::Isometry3d tip_pose = Eigen::Isometry3d::Identity();                   ///< in world or in the tool's root link
  Eigen::Matrix<double, 6, 1> tip_twist = Eigen::Matrix<double, 6, 1>::Zero();  ///< linear, angular [m/s], [rad/s]
  int pull_particle = -1;
  Eigen::Vector3d pull_target = Eigen::Vector3d::Zero();  ///< in world [m]
};

/// Whether both are of one node; nobody in particular is one, too.
bool isOfOneNode(const SampleSender* a, const SampleSender* b);

/// Of its sender; without one, that which its values suggest.
std::string topicOf(const InputSample& sample);

/// Which stamps a message of an input may have, compared with the simulator's time at its arrival. A node whose clock
/// is wrong is told so; its messages neither wait nor count.
struct InputWindow {
  std::int64_t look_ahead;  ///< later than that: refused [ns]
  std::int64_t staleness;   ///< older than that: refused [ns]

  static InputWindow ofWallClock() { return {500'000'000, 1'000'000'000}; }
  /// Nodes that follow /clock cannot be wrong, but may send motions ahead, or be slow.
  static InputWindow ofSimulatedTime() { return {60'000'000'000, INT64_MAX}; }
};

/// What is wrong with a stamp [ns] at the simulator's time `now` [ns], as the rest of a sentence: "its stamp is ...";
/// empty: nothing. Stamp 0, "as soon as possible", is always right.
std::string faultOf(std::int64_t stamp, std::int64_t now, const InputWindow& window);

}  // namespace vibe::sim
