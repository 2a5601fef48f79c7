#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include <rosbag/bag.h>

#include "publishing/outlet.hpp"
#include "publishing/publishers.hpp"
#include "replay/replay.hpp"

namespace vibe::sim {

/// Makes a whole recording of a thinned one: what the recorder kept whole is copied, and what a replay computes
/// (recordingRules()) is written anew, message by message as the simulator sent it. Beside the listener's calls:
///
///   BagFiller filler(recording, "whole.bag");
///   Replay replay(recording, filler);
///   while (!replay.done()) replay.step();
///   filler.finish(replay.session());
///
/// Limits: /tf is not written (robot_state_publisher makes it from joint_states), and /clock has no messages from
/// pauses.
class BagFiller : public Replay::Listener {
 public:
  /// The calls of the listener and finish() throw an Error if the disk is full.
  /// @throws Error if the file is there already or cannot be written
  BagFiller(const Recording& recording, const std::string& file);
  ~BagFiller() override;

  void newModel(const TimedSimulation& simulation) override;
  void newState(const TimedSimulation& simulation) override;
  void afterStep(const TimedSimulation& simulation) override;

  /// Writes what the simulator sends when it ends, copies the rest and ends the file.
  /// @throws Error if it cannot be written
  void finish(const TimedSimulation& simulation);

  std::uint64_t messageCount() const { return count_; }

 private:
  void publish(const TimedSimulation& simulation, const std::function<void()>& send);
  [[noreturn]] void fail(const std::string& why);

  const Recording& recording_;
  std::unique_ptr<rosbag::Bag> bag_;
  std::string file_;
  bool failed_ = false;
  BagTarget target_;
  Publishers publishers_;
  std::uint64_t count_ = 0;
};

}  // namespace vibe::sim
