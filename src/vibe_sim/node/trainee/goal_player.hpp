#pragma once

#include <cstdint>
#include <memory>
#include <optional>

#include <ros/node_handle.h>
#include <std_msgs/String.h>

#include "trainee/goal_server.hpp"
#include "trainee/trainee_topics.hpp"
#include "vibe_core/trainee/protocol.hpp"
#include "vibe_core/trainee/trainee.hpp"

namespace vibe::sim {

/// Performs the goals of a protocol, and those that other nodes send, by what the simulator publishes. It answers the
/// end of every step with the input of the next, so that in lock-step a session has the bits of vibe_headless. When the
/// session begins anew (reset, snapshot, other scene), so does the protocol; goals of others have failed then.
class GoalPlayer {
 public:
  /// @param lockstep        wait for the particles of each step; else use the newest
  /// @param exit_when_done  shut the node down when all goals have ended
  GoalPlayer(ros::NodeHandle handle, Protocol protocol, bool lockstep, bool exit_when_done);

 private:
  void onScene(const std_msgs::String& message);
  void onResult(const vibe_msgs::StepResult::ConstPtr& message);
  void onParticles(const sensor_msgs::PointCloud2::ConstPtr& message);
  void resend(const ros::WallTimerEvent& event);

  void goOn();
  bool knowsModel(std::uint32_t revision);
  void perform(const Sight& sight);
  void begin();
  void end();
  void report(int number, const GoalResult& result) const;

  Protocol protocol_;
  bool lockstep_, exit_when_done_;
  InputSender sender_;
  GoalServer server_;
  ObservationQueue queue_;
  ros::Subscriber scene_, result_, particles_;
  ros::WallTimer timer_;

  std::shared_ptr<const Model> model_;
  std::uint32_t scenes_ = 0;                     // received
  std::optional<std::uint32_t> first_revision_;  // of the first scene
  std::optional<Sight> sight_;                   // the next one to act on
  std::unique_ptr<Trainee> trainee_;
  std::int64_t last_step_ = -1;

  StepInput last_sent_;
  std::int64_t last_stamp_ = -1;  // [ns]; -1: nothing has been sent
  double last_send_ = 0;          // steady time [s]
};

}  // namespace vibe::sim
