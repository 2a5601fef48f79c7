#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include <ros/node_handle.h>
#include <std_msgs/UInt32.h>
#include <vibe_msgs/SendGoal.h>

#include "publishing/warning_gate.hpp"
#include "trainee/goal_book.hpp"

namespace vibe::sim {

/// Takes goals from other nodes (topic and service trainee/goal, topic trainee/cancel) and says what becomes of all of
/// them (topic trainee/progress).
class GoalServer {
 public:
  GoalServer(ros::NodeHandle handle, const std::string& skill);

  /// Goals of the node itself.
  void add(const Goal& goal) { book_.add("", goal); }
  /// A session begins: goals that are left from the one before have failed; queued ones go to its trainee.
  /// @param trainee  outlives the session, that is, the next call
  void begin(std::shared_ptr<const Model> model, Trainee& trainee);
  /// The session has ended, and no other has begun.
  void end();
  /// Notes and publishes what has changed in a step.
  /// @param stamp  of its end [ns]
  void follow(const Observation& seen, std::int64_t stamp);

 private:
  bool onCall(vibe_msgs::SendGoal::Request& request, vibe_msgs::SendGoal::Response& response);
  void onGoal(const vibe_msgs::TraineeGoal& message);
  void onCancel(const std_msgs::UInt32& message);
  std::uint32_t take(const vibe_msgs::TraineeGoal& message);
  void publish();
  void complain(const std::string& sentence);

  std::string skill_;
  ros::Publisher progress_;
  ros::Subscriber goal_, cancel_;
  ros::ServiceServer service_;
  GoalBook book_;
  WarningGate gate_;
  std::shared_ptr<const Model> model_;  // null: the scene is not known yet
  Trainee* trainee_ = nullptr;
  std::int64_t stamp_ = 0;
};

}  // namespace vibe::sim
