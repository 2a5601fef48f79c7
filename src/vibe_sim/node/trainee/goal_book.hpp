#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <vibe_msgs/TraineeProgress.h>

#include "vibe_core/trainee/protocol.hpp"
#include "vibe_core/trainee/trainee.hpp"

namespace vibe::sim {

/// All goals of a trainee's node with what has become of them, through all sessions of the node: what trainee/progress
/// says.
class GoalBook {
 public:
  /// @return id
  std::uint32_t add(const std::string& label, const Goal& goal);
  /// Notes a goal that was refused.
  void refuse(const std::string& label, const std::string& text, const std::string& reason);

  /// Gives a new trainee everything that is queued.
  void start(Trainee& trainee);
  /// The session has ended: what has not been reached has failed.
  void abandon(const std::string& reason);
  /// Cancels a goal, or all with id 0.
  /// @param trainee  null: none has begun
  /// @return false if there is no such goal that has not ended
  bool cancel(std::uint32_t id, Trainee* trainee);
  /// Notes what the trainee has done in a step.
  void follow(const Trainee& trainee, const Observation& seen);

  /// All goals; the header is the caller's.
  const vibe_msgs::TraineeProgress& message() const { return message_; }
  /// Whether it has changed since the last call.
  bool takeChange();

 private:
  vibe_msgs::TraineeProgress message_;
  std::vector<Goal> goals_;         // of the queued ones; unused for the others
  std::vector<std::size_t> entry_;  // of each goal of the present trainee
  std::size_t ended_ = 0;           // goals of the present trainee
  bool changed_ = true;

  vibe_msgs::GoalProgress& append(const std::string& label, const std::string& text);
  void followCurrent(const Trainee& trainee, vibe_msgs::GoalProgress& entry);
  void cancelEntry(std::size_t entry, Trainee* trainee);
  void fail(const std::string& reason, vibe_msgs::GoalProgress& entry);
};

}  // namespace vibe::sim
