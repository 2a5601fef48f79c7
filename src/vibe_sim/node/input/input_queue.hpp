#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Geometry>
#include <boost/circular_buffer.hpp>
#include <boost/lockfree/spsc_queue.hpp>

#include "input/input_interpreter.hpp"
#include "vibe_core/input/step_input.hpp"
#include "vibe_core/model/model.hpp"

namespace vibe::sim {

/// Where an input comes from. Each has its own queue, because each has its own rate.
enum class InputChannel { Scope, Overstitch, Buttons, Pull };
constexpr int kInputChannelCount = 4;
constexpr int kLockstepChannelCount = 3;  ///< the first ones; a pull is optional

/// A pull ends if no message arrives for this long: its publisher may be gone [ns of the simulator's time].
constexpr std::int64_t kPullTimeout = 2'000'000'000;

/// Buttons that are pressed are released if no message arrives for this long: whoever presses them may be gone [ns of
/// the simulator's time].
constexpr std::int64_t kButtonTimeout = 1'000'000'000;

/// What a sample of the channel Scope says: joint positions, or the pose that scope_tip is to reach.
enum class ScopeTarget { Joints, TipInWorld, TipInBase };

/// One valid message, free of ROS. Only the values of its channel count.
struct InputSample {
  InputChannel channel = InputChannel::Scope;
  std::int64_t stamp = 0;  ///< time of the sample [ns]; 0: as soon as possible
  JointArray joints{};
  bool move = false;  ///< the joints are the goal of a JointMove from where the hand is; else where it is to be now
  std::array<std::uint8_t, kButtonCount> buttons{};
  ScopeTarget target = ScopeTarget::Joints;
  Eigen::Isometry3d tip_pose = Eigen::Isometry3d::Identity();  ///< in world or in the tool's root link
  int pull_particle = -1;
  Eigen::Vector3d pull_target = Eigen::Vector3d::Zero();  ///< in world [m]
};

/// Holds what has arrived until the step for which it is due, and the last valid values after that.
///
/// One thread pushes, one thread takes steps. Neither waits for the other or asks for memory: samples go through a ring
/// without a lock. push() belongs to the first thread, now() to any, all other functions to the second.
class InputQueue {
 public:
  /// Samples that may wait in one channel; more means that a publisher stamps far into the future.
  static constexpr std::size_t kCapacity = 4096;
  /// Samples of all channels between two calls of collect().
  static constexpr std::size_t kInbox = 4 * kCapacity;

  InputQueue();

  /// A sample with the stamp of one that still waits replaces it.
  /// @return false if the channel is full and the sample was not taken
  bool push(const InputSample& sample);

  /// Takes in what was pushed. Functions that look at samples begin with it; without them, to be called now and
  /// then.
  void collect();

  /// Whether every channel of lock-step has delivered a sample stamped `stamp` or later: all that matters at that time
  /// is known.
  bool knownUntil(std::int64_t stamp);
  /// Names of the channels for which that is not so, for a message.
  std::string missingAt(std::int64_t stamp);

  /// Applies to `input` everything that is due at `stamp`, in the order of stamps; samples from the past count as of
  /// now, in the order of arrival. Targets of the tip become joints by the tool's inverse kinematics; a pull
  /// without a message for kPullTimeout ends. A `stamp` before the last one means that the clock was set back: what
  /// waits is due at once.
  /// A move ends at its goal, or when another sample for its joints is applied.
  /// @param real_time  release buttons without a message for kButtonTimeout; false where time does not pass as it does
  ///                   for the publishers
  /// @param hand       where the hand is, from where a move begins; empty: where `input` says
  /// @return one sentence per sample that the model cannot use and per input that has fallen silent
  std::vector<std::string> apply(std::int64_t stamp, const Model& model, StepInput& input, bool real_time = true,
                                 const std::optional<JointArray>& hand = {});

  /// Whether a move of the scope or of the suturing device is under way.
  bool moves(InputChannel channel) const;
  /// Ends all moves where they are, because another state has taken over.
  void endMoves();

  /// Forgets everything, e.g. because time starts again.
  void clear();

  /// Stamp of the last apply(); 0: none yet.
  std::int64_t now() const;

 private:
  struct Queue {
    boost::circular_buffer<InputSample> waiting{kCapacity};  // ascending stamps
    std::int64_t newest = 0;                                 // max stamp delivered so far
  };
  // of the thread that pushes
  std::array<std::int64_t, kInputChannelCount> last_pushed_{};  // stamp [ns]

  // between the two
  boost::lockfree::spsc_queue<InputSample> inbox_{kInbox};
  std::array<std::atomic<std::size_t>, kInputChannelCount> taken_{};  // samples in the inbox and waiting, at most
  std::atomic<std::int64_t> applied_until_{0};

  // of the thread that steps
  std::array<Queue, kInputChannelCount> queues_;
  std::array<std::int64_t, kInputChannelCount> last_{};  // time at which a sample of the channel was applied last
  std::array<std::optional<JointMove>, kInputChannelCount> moves_;

  void insert(const InputSample& sample);
  std::string applySample(const InputSample& sample, std::int64_t stamp, const Model& model, const JointArray& hand,
                          StepInput& input);
  std::string beginMove(const InputSample& sample, std::int64_t stamp, const Model& model, const JointArray& hand);
  void applyMoves(std::int64_t stamp, JointArray& joints);
  void setBack(std::int64_t stamp);
  bool isSilent(InputChannel channel, std::int64_t stamp, std::int64_t timeout) const;
};

const char* toString(InputChannel channel);

}  // namespace vibe::sim
