#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <rosbag/bag.h>

#include "publishing/message_sink.hpp"
#include "publishing/publishers.hpp"
#include "replay/replay.hpp"

namespace vibe::sim {

/// Which messages in the namespace of the chosen session belong to it: by their identity, and those without by time,
/// from the first one with its identity to the first with that of the next session.
class SessionFilter {
 public:
  /// @throws Error if sessions in the namespace overlap or have no identity
  explicit SessionFilter(const Recording& recording);

  bool has(const rosbag::MessageInstance& message) const;

 private:
  std::string prefix_;
  std::uint64_t id_;
  bool is_alone_ = true;
  std::vector<std::string> inner_;  // namespaces of other simulators within it
  ros::Time from_{ros::TIME_MIN}, to_{ros::TIME_MAX};
};

/// What a replay is written as.
enum class Filling {
  Whole,      ///< what the recorder kept whole is copied, and what a replay computes (recordingRules()) written anew
  NewSession  ///< all of it is written anew, with the hashes of this build, and thinned as a recorder does. The same
              ///< inputs give the same bytes: times that depend on the machine are left out.
};

/// Makes a recording of a replay, message by message as the simulator sent it. Beside the listener's calls:
///
///   BagFiller filler(recording, "whole.bag");
///   Replay replay(recording, filler);
///   while (!replay.done()) replay.step();
///   filler.finish(replay.session());
///
/// Of several sessions in the namespace only the chosen one is copied; other namespaces are copied whole.
/// Limits: /tf is not written (robot_state_publisher makes it from joint_states), and /clock has no messages from
/// pauses.
class BagFiller : public Replay::Listener {
 public:
  /// The calls of the listener and finish() throw an Error if the disk is full.
  /// @throws Error if the file is there already or cannot be written, or if the recording has other sessions in the
  /// namespace that overlap in time or have no identity, so that the rest of the messages cannot be told apart
  BagFiller(const Recording& recording, const std::string& file, Filling filling = Filling::Whole);
  ~BagFiller() override;

  void newModel(const TimedSimulation& simulation) override;
  void newState(const TimedSimulation& simulation) override;
  void beforeStep(const TimedSimulation& simulation) override;
  void afterStep(const TimedSimulation& simulation) override;

  /// Writes what the simulator sends when it ends, copies the rest and ends the file.
  /// @throws Error if it cannot be written
  void finish(const TimedSimulation& simulation);

  std::uint64_t messageCount() const { return count_; }

 private:
  void publish(const TimedSimulation& simulation, const std::function<void()>& send);
  void copyRest();
  void sendEnd(const TimedSimulation& simulation);
  [[noreturn]] void fail(const std::string& why);

  const Recording& recording_;
  Filling filling_;
  SessionFilter filter_;
  std::unique_ptr<rosbag::Bag> bag_;
  std::string file_;
  bool failed_ = false;
  BagTarget target_;
  Publishers publishers_;
  std::uint64_t count_ = 0;
};

}  // namespace vibe::sim
