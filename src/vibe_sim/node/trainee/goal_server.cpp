#include "trainee/goal_server.hpp"

#include <utility>

#include <ros/console.h>

#include "conversions/conversions.hpp"
#include "conversions/goal_message.hpp"
#include "vibe_core/clocks/step_timer.hpp"
#include "vibe_core/program/error.hpp"

namespace vibe::sim {

namespace {

constexpr std::uint32_t kGoalQueue = 1000;

}  // namespace

GoalServer::GoalServer(ros::NodeHandle handle, const std::string& skill)
    : skill_(skill),
      progress_(handle.advertise<vibe_msgs::TraineeProgress>("trainee/progress", kGoalQueue, true)),
      goal_(handle.subscribe("trainee/goal", kGoalQueue, &GoalServer::onGoal, this)),
      cancel_(handle.subscribe("trainee/cancel", kGoalQueue, &GoalServer::onCancel, this)),
      service_(handle.advertiseService("trainee/goal", &GoalServer::onCall, this)) {
  publish();
}

void GoalServer::begin(std::shared_ptr<const Model> model, Trainee& trainee) {
  model_ = std::move(model);
  trainee_ = &trainee;
  book_.start(trainee);
}

void GoalServer::end() {
  trainee_ = nullptr;
  book_.abandon("the session has ended");
}

void GoalServer::follow(const Observation& seen, std::int64_t stamp) {
  stamp_ = stamp;
  book_.follow(*trainee_, seen);
  publish();
}

/// @throws Error if the goal is refused
std::uint32_t GoalServer::take(const vibe_msgs::TraineeGoal& message) {
  if (!model_) throw Error("The trainee has not seen the scene yet; start the simulator, or wait until it has.");
  const Goal goal = readGoal(message);
  const std::string refusal = refusalIn(*model_, message, goal);
  if (!refusal.empty()) throw Error(refusal);
  const std::uint32_t id = book_.add(message.label, goal);
  if (trainee_) book_.start(*trainee_);
  return id;
}

bool GoalServer::onCall(vibe_msgs::SendGoal::Request& request, vibe_msgs::SendGoal::Response& response) {
  try {
    response.id = take(request.goal);
    response.success = 1;
    response.message = "Goal " + std::to_string(response.id) + ": " + book_.message().goals.back().goal + ".";
  } catch (const Error& error) {
    response.message = error.what();
  }
  publish();
  return true;
}

void GoalServer::onGoal(const vibe_msgs::TraineeGoal& message) {
  try {
    take(message);
  } catch (const Error& error) {
    complain(std::string("A goal is refused: ") + error.what());
    book_.refuse(message.label, message.kind, error.what());
  }
  publish();
}

void GoalServer::onCancel(const std_msgs::UInt32& message) {
  if (!book_.cancel(message.data, trainee_) && message.data != 0)
    complain("There is no goal " + std::to_string(message.data) + " to cancel that has not ended.");
  publish();
}

void GoalServer::complain(const std::string& sentence) {
  if (gate_.admits(sentence, steadyTime())) ROS_WARN_STREAM(sentence);
}

void GoalServer::publish() {
  if (!book_.takeChange()) return;
  vibe_msgs::TraineeProgress message = book_.message();
  message.header.stamp = toRosTime(stamp_);
  message.skill = skill_;
  progress_.publish(message);
}

}  // namespace vibe::sim
