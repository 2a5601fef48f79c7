#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include <ros/node_handle.h>
#include <vibe_msgs/ReplayCommand.h>
#include <vibe_msgs/ReplayStatus.h>

#include "publishing/publishers.hpp"
#include "recording/recording.hpp"
#include "replay/replay.hpp"

namespace vibe::sim {

/// A moment of a recording that is worth going to.
struct ReplayMark {
  double time = 0;   ///< since the start of the recording [s]
  std::string text;  ///< "phase suture", "bite"
};

/// Changes of phase, marks, bites, T-tags, cinches and mishaps, in order of time.
/// @throws Error if the bag cannot be read
std::vector<ReplayMark> readMarks(const Recording& recording);

/// Plays a recording into the graph as the simulator would: all of its topics, computed again, at the recorded pace or
/// another one. Goes to any time on command; stamps only go forward, so that listeners need not be set back.
class Player : private Replay::Listener {
 public:
  /// @param recording  lives as long as the player
  /// @throws Error if it cannot be begun
  Player(const Recording& recording, ros::NodeHandle handle, bool plays, double rate);

  /// Whatever is due now: commands, steps, the status. Call often; takes 50 ms or so at most, but for a command to go
  /// to a time far from a snapshot.
  /// @throws Error if the recording cannot be played on
  void spinOnce();

 private:
  void newModel(const TimedSimulation& simulation) override;
  void newState(const TimedSimulation& simulation) override;
  void beforeStep(const TimedSimulation& simulation) override;
  void afterStep(const TimedSimulation& simulation) override;
  void obey(const vibe_msgs::ReplayCommand& command);
  void attempt(const std::function<void()>& move);
  void restartPace();
  void playDueSteps();
  void publishStatus(bool now);

  const Recording& recording_;
  Publishers publishers_;
  ros::Publisher status_;
  ros::Subscriber commands_;
  std::uint32_t announced_run_ = 0;
  Replay replay_;
  vibe_msgs::ReplayStatus message_;
  std::string error_;                      // of the last command; empty: none
  double pace_begin_ = 0, pace_time_ = 0;  // steady time at which the replay was at this time [s]
  double last_status_ = 0, last_heartbeat_ = 0, last_whole_ = 0;  // steady time [s]
};

}  // namespace vibe::sim
