#pragma once
#include <ros/node_handle.h>
#include <vibe_msgs/ProcedureEvent.h>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "panels/panel_messages.hpp"
#include "vibe_operator/messages/session_watch.hpp"

namespace vibe::rviz_plugins {

/// Subscribes to what the panel shows. Callbacks run in the thread that spins the queue of the node, which in rviz is
/// the thread of the widgets.
class ProcedureSubscriptions {
 public:
  using EventHandler = std::function<void(const vibe_msgs::ProcedureEvent&)>;
  explicit ProcedureSubscriptions(EventHandler handle_event) : handle_event_(std::move(handle_event)) {}

  /// Starts again in this (valid) namespace; empty: that of the node.
  void listen(const std::string& name_space) {
    subscribers_.clear();
    messages_ = {};
    simulator_.forget();
    delay_ = {};
    ros::NodeHandle handle(name_space);
    state_topic_ = handle.resolveName("procedure/state");
    subscribeAll(handle);
  }

  const PanelMessages& messages() const { return messages_; }

  Freshness freshness(double now) const {
    if (!messages_.force && !messages_.state) {
      const double none = std::numeric_limits<double>::quiet_NaN();
      return {none, none};
    }
    return {now - last_moving_, delay_.value(now)};
  }

  /// One sentence while there is no simulator; empty if all is well.
  std::string problem(double now) const { return simulator_.problem(state_topic_, now); }
  /// Stamp that counts as the beginning of the session's time [s].
  double origin() const { return messages_.state ? messages_.state->header.stamp.toSec() - messages_.state->time : 0; }

 private:
  static constexpr std::uint32_t kEventQueue = 1000;  ///< many come in one step, and all are shown

  EventHandler handle_event_;
  std::vector<ros::Subscriber> subscribers_;
  PanelMessages messages_;
  std::string state_topic_;
  operating::SimulatorWatch simulator_;
  operating::MaxOfWindow delay_;
  double last_moving_ = 0;  // arrival of the last force or state [s]

  template <class Message>
  void take(boost::shared_ptr<const Message>& place, const boost::shared_ptr<const Message>& message) {
    simulator_.received(operating::steadySeconds());
    place = message;
  }

  void subscribeAll(ros::NodeHandle& handle) {
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

  void recordArrival(const ros::Time& stamp) {
    last_moving_ = operating::steadySeconds();
    if (!ros::Time::isSimTime()) delay_.add((ros::Time::now() - stamp).toSec(), last_moving_);
  }
};

}  // namespace vibe::rviz_plugins
