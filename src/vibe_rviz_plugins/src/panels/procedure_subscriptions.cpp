#include "panels/procedure_subscriptions.hpp"

#include <limits>

namespace vibe::rviz_plugins {
namespace {

constexpr std::uint32_t kEventQueue = 1000;  // many come in one step, and all are shown

}  // namespace

void ProcedureSubscriptions::listen(const std::string& name_space) {
  subscribers_.clear();
  messages_ = {};
  simulator_.forget();
  delay_ = {};
  ros::NodeHandle handle(name_space);
  state_topic_ = handle.resolveName("procedure/state");
  subscribeAll(handle);
}

template <class Message>
void ProcedureSubscriptions::take(boost::shared_ptr<const Message>& place,
                                  const boost::shared_ptr<const Message>& message) {
  simulator_.received(operating::steadySeconds());
  place = message;
}

void ProcedureSubscriptions::subscribeAll(ros::NodeHandle& handle) {
  using vibe_msgs::ProcedureEvent;
  const auto add = [this](const ros::Subscriber& subscriber) { subscribers_.push_back(subscriber); };
  add(handle.subscribe<vibe_msgs::ProcedureState>("procedure/state", 1, [this](const auto& message) {
    take(messages_.state, message);
    if (!messages_.force) recordArrival(message->header.stamp);
  }));
  add(handle.subscribe<vibe_msgs::SkillMetrics>("procedure/skill_metrics", 1,
                                                [this](const auto& message) { take(messages_.skill, message); }));
  add(handle.subscribe<geometry_msgs::WrenchStamped>("scope/measured_cf", 1, [this](const auto& message) {
    take(messages_.force, message);
    recordArrival(message->header.stamp);
  }));
  add(handle.subscribe<vibe_msgs::SutureArray>("sutures", 1,
                                               [this](const auto& message) { take(messages_.sutures, message); }));
  // of a trainee, not of the simulator: it does not say that there is one
  add(handle.subscribe<vibe_msgs::TraineeProgress>("trainee/progress", 1,
                                                   [this](const auto& message) { messages_.progress = message; }));
  add(handle.subscribe<vibe_msgs::SolverStatistics>(
      "solver_statistics", 1, [this](const auto& message) { take(messages_.solver_statistics, message); }));
  add(handle.subscribe<ProcedureEvent>("procedure/events", kEventQueue, [this](const auto& message) {
    simulator_.received(operating::steadySeconds());
    handle_event_(*message);
  }));
}

void ProcedureSubscriptions::recordArrival(const ros::Time& stamp) {
  last_moving_ = operating::steadySeconds();
  if (!ros::Time::isSimTime()) delay_.add((ros::Time::now() - stamp).toSec(), last_moving_);
}

Freshness ProcedureSubscriptions::freshness(double now) const {
  if (!messages_.force && !messages_.state) {
    const double none = std::numeric_limits<double>::quiet_NaN();
    return {none, none};
  }
  return {now - last_moving_, delay_.value(now)};
}

double ProcedureSubscriptions::origin() const {
  return messages_.state ? messages_.state->header.stamp.toSec() - messages_.state->time : 0;
}

}  // namespace vibe::rviz_plugins
