#pragma once
#include <array>
#include <atomic>
#include <boost/circular_buffer.hpp>
#include <boost/lockfree/spsc_queue.hpp>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "input/input_sample.hpp"

namespace vibe::sim {

/// A sample that has no effect, because its node has sent a later one that counts already.
struct OvertakenSample {
  InputSample sample;       ///< with the stamp of its message
  std::int64_t newest = 0;  ///< stamp of the one that counts [ns]
};

/// What is due at a step.
struct DueInput {
  std::int64_t since = 0, stamp = 0;  ///< of the step before, 0: none; of this step [ns]
  std::vector<InputSample> samples;   ///< channel by channel, each in the order of stamps
  /// How long no sample of a channel was due; 0 while one waits: who has promised a later sample is not silent [ns].
  std::array<std::int64_t, kInputChannelCount> silence{};
  /// The last of each channel since the step before.
  std::array<std::optional<OvertakenSample>, kInputChannelCount> overtaken;

  bool isSilent(InputChannel channel, std::int64_t timeout) const {
    return silence[static_cast<std::size_t>(channel)] > timeout;
  }
};

/// For that long after a step has used a sample, older ones of its node have no effect. After that they count: the
/// clock of the node has been set back [ns of the simulator's time].
constexpr std::int64_t kOvertakes = 1'000'000'000;

/// Holds what has arrived until the step for which it is due. What a sample means is the InputInterpreter's.
///
/// Joints and pulls are states, of which the latest stamp of a node wins. Buttons are actions, of which none is lost:
/// they count in the order of stamps while they wait, and in that of arrival if they are late.
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

  /// A sample with the stamp of one of the same node that still waits replaces it, of buttons only one that says the
  /// same.
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

  /// Takes out everything that is due at `stamp`; samples from the past count as of now. A `stamp` before the last one
  /// means that the clock was set back: what waits is due at once.
  /// @return valid until the next call
  const DueInput& takeDue(std::int64_t stamp);

  /// Forgets everything, e.g. because time starts again.
  void clear();

  /// Stamp of the last takeDue(); 0: none yet.
  std::int64_t now() const { return applied_until_; }

 private:
  struct Newest {
    const SampleSender* sender;
    std::int64_t stamp, used;  // of the newest sample that counts; when it began to [ns]
  };
  struct Queue {
    boost::circular_buffer<InputSample> waiting{kCapacity};  // ascending stamps
    std::int64_t newest = 0;                                 // max stamp delivered so far
    std::int64_t last_due = 0;                               // time at which a sample was taken out last
    std::vector<Newest> newest_of;                           // nodes; joints and pulls only
  };
  // of the thread that pushes
  std::array<InputSample, kInputChannelCount> last_pushed_;

  // between the two
  boost::lockfree::spsc_queue<InputSample> inbox_{kInbox};
  std::array<std::atomic<std::size_t>, kInputChannelCount> taken_{};  // samples in the inbox and waiting, at most
  std::atomic<std::int64_t> applied_until_{0};

  // of the thread that steps
  std::array<Queue, kInputChannelCount> queues_;
  DueInput due_;
  std::array<std::optional<OvertakenSample>, kInputChannelCount> overtaken_;  // since the step before

  void insert(const InputSample& sample);
  bool isOvertaken(const InputSample& sample);
  static void count(Queue& queue, const InputSample& sample, std::int64_t now);
  void dropFirst(Queue& queue, std::int64_t stamp);
  void setBack(std::int64_t stamp);
};

}  // namespace vibe::sim
