#pragma once
#include <ros/node_handle.h>
#include <vibe_msgs/ProcedureEvent.h>

#include <functional>
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
  void listen(const std::string& name_space);

  const PanelMessages& messages() const { return messages_; }
  Freshness freshness(double now) const;
  /// One sentence while there is no simulator; empty if all is well.
  std::string problem(double now) const { return simulator_.problem(state_topic_, now); }
  /// Stamp that counts as the beginning of the session's time [s].
  double origin() const;

 private:
  EventHandler handle_event_;
  std::vector<ros::Subscriber> subscribers_;
  PanelMessages messages_;
  std::string state_topic_;
  operating::SimulatorWatch simulator_;
  operating::MaxOfWindow delay_;
  double last_moving_ = 0;  // arrival of the last force or state [s]

  template <class Message>
  void take(boost::shared_ptr<const Message>& place, const boost::shared_ptr<const Message>& message);
  void subscribeAll(ros::NodeHandle& handle);
  void recordArrival(const ros::Time& stamp);
};

}  // namespace vibe::rviz_plugins
