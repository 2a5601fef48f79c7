#include "trainee/goal_player.hpp"

#include <algorithm>
#include <cstdio>
#include <utility>

#include <ros/console.h>
#include <ros/init.h>

#include "simulation/scene_source.hpp"
#include "vibe_core/clocks/step_timer.hpp"
#include "vibe_core/program/error.hpp"

namespace vibe::sim {

namespace {

constexpr std::uint32_t kResultQueue = 10000;  // of small messages: none may be lost

bool isPressed(const StepInput& input) {
  return std::any_of(input.buttons.begin(), input.buttons.end(), [](std::uint8_t b) { return b != 0; });
}

}  // namespace

GoalPlayer::GoalPlayer(ros::NodeHandle handle, Protocol protocol, bool lockstep, bool exit_when_done)
    : protocol_(std::move(protocol)),
      lockstep_(lockstep),
      exit_when_done_(exit_when_done),
      sender_(handle),
      server_(handle, protocol_.skill.name),
      queue_(lockstep) {
  const ros::TransportHints no_delay = ros::TransportHints().tcpNoDelay();
  scene_ = handle.subscribe("scene", 10, &GoalPlayer::onScene, this);
  result_ = handle.subscribe("step_result", kResultQueue, &GoalPlayer::onResult, this, no_delay);
  particles_ = handle.subscribe("tissue/particles", lockstep ? 10 : 1, &GoalPlayer::onParticles, this, no_delay);
  if (lockstep) timer_ = handle.createWallTimer(ros::WallDuration(0.1), &GoalPlayer::resend, this);
}

void GoalPlayer::onScene(const std_msgs::String& message) {
  try {
    model_ = modelOfText(message.data, "topic scene").model;
  } catch (const Error& error) {
    model_.reset();
    ROS_ERROR_STREAM("The trainee does not know the scene and does nothing: " << error.what());
  }
  ++scenes_;
  end();
  goOn();
}

void GoalPlayer::onResult(const vibe_msgs::StepResult::ConstPtr& message) {
  queue_.push(message);
  goOn();
}

void GoalPlayer::onParticles(const sensor_msgs::PointCloud2::ConstPtr& message) {
  queue_.push(message);
  goOn();
}

// A new scene has a new revision, and its messages arrive in any order.
bool GoalPlayer::knowsModel(std::uint32_t revision) {
  if (!first_revision_) first_revision_ = revision;
  return scenes_ > revision - *first_revision_;
}

void GoalPlayer::goOn() {
  try {
    while (sight_ || (sight_ = queue_.next())) {
      if (!knowsModel(sight_->revision)) return;
      const Sight sight = std::move(*sight_);
      sight_.reset();
      if (model_) perform(sight);
    }
  } catch (const Error& error) {
    ROS_ERROR_STREAM_THROTTLE(1, error.what());
  }
}

void GoalPlayer::perform(const Sight& sight) {
  if (!lockstep_ && !sender_.hasListeners()) return;
  if (sight.seen.step != last_step_ + 1) end();
  if (!trainee_) begin();
  last_step_ = sight.seen.step;
  // without another input, so that in lock-step the session ends in the state in which the last goal ended
  if (exit_when_done_ && !trainee_->goals().empty() && trainee_->done()) return ros::requestShutdown();
  const bool idle = trainee_->done();
  last_sent_ = trainee_->next(sight.seen);
  last_stamp_ = sight.stamp;
  last_send_ = steadyTime();
  // without a goal, others may drive; but a button that nobody presses any more would be released
  if (lockstep_ || !idle)
    sender_.send(last_sent_, last_stamp_);
  else if (isPressed(last_sent_))
    sender_.sendButtons(last_sent_, last_stamp_);
  server_.follow(sight.seen, sight.stamp);
}

void GoalPlayer::begin() {
  trainee_ = std::make_unique<Trainee>(model_, protocol_.skill, protocol_.seed);
  for (const Goal& goal : protocol_.goals) server_.add(goal);
  server_.begin(model_, *trainee_);
  trainee_->on_activity = [](const std::string& what) {
    std::printf("trainee: %s\n", what.c_str());
    std::fflush(stdout);
  };
  trainee_->on_result = [this](int number, const GoalResult& result) { report(number, result); };
}

void GoalPlayer::end() {
  if (trainee_) server_.end();
  trainee_.reset();
}

void GoalPlayer::report(int number, const GoalResult& result) const {
  std::printf("trainee: t = %.1f s  goal %d of %zu, %s: %s%s%s\n",
              static_cast<double>(last_step_) * model_->scene.step_period, number + 1, trainee_->goals().size(),
              describe(trainee_->goals()[static_cast<std::size_t>(number)]).c_str(),
              result.reached ? "reached" : "given up", result.reason.empty() ? "" : ", ", result.reason.c_str());
  std::fflush(stdout);
}

void GoalPlayer::resend(const ros::WallTimerEvent&) {
  if (last_stamp_ < 0 || steadyTime() - last_send_ < kResendAfter || !sender_.hasListeners()) return;
  last_send_ = steadyTime();
  sender_.send(last_sent_, last_stamp_);
}

}  // namespace vibe::sim
