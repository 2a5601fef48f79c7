#include "simulator/master_watch.hpp"

#include <ros/console.h>
#include <ros/master.h>
#include <ros/this_node.h>
#include <ros/time.h>

#include "vibe_core/clocks/step_timer.hpp"

namespace vibe::sim {

namespace {

/// Names of the nodes that publish a topic, but for this one; empty: none, or the master does not answer.
std::string othersThatPublish(const std::string& topic) {
  XmlRpc::XmlRpcValue request, response, payload;
  request[0] = ros::this_node::getName();
  if (!ros::master::execute("getSystemState", request, response, payload, false)) return "";
  std::string names;
  for (int t = 0; t < payload[0].size(); ++t) {
    if (std::string(payload[0][t][0]) != topic) continue;
    for (int n = 0; n < payload[0][t][1].size(); ++n) {
      const std::string name = payload[0][t][1][n];
      if (name != ros::this_node::getName()) names += (names.empty() ? "" : ", ") + name;
    }
  }
  return names;
}

}  // namespace

MasterWatch::MasterWatch(const ros::NodeHandle& handle, Publishers& publishers, double timeout)
    : publishers_(publishers), timeout_(timeout) {
  timer_ = handle.createWallTimer(ros::WallDuration(1.0), [this](const ros::WallTimerEvent&) { check(); });
}

void MasterWatch::check() {
  const bool is_there = ros::master::check();
  if (was_there_ && !is_there) {
    ROS_ERROR_STREAM("The ROS master at " << ros::master::getURI()
                                          << " does not answer; the simulation goes on for those who are connected.");
  }
  if (!was_there_ && is_there) {
    ROS_WARN("A ROS master answers again; if it is a new one, restart this node so that others can find it.");
  }
  was_there_ = is_there;
  if (is_there && ros::Time::isSimTime()) lookForRivalClock();
  const bool alone = !is_there && !publishers_.hasListener();
  const double now = steadyTime();
  if (!alone) alone_since_ = 0;
  if (alone && alone_since_ == 0) alone_since_ = now;
  if (alone && now - alone_since_ >= timeout_ && !hopeless_) {
    hopeless_ = true;
    ROS_ERROR_STREAM("There has been neither a ROS master nor a listener for " << timeout_ << " s; giving up.");
  }
}

void MasterWatch::lookForRivalClock() {
  const std::string others = othersThatPublish("/clock");
  if (!others.empty() && others != rival_) {
    const std::string sentence = "Time jumps: /clock is also published by " + others +
                                 "; stop one of them (of two simulators, give each its own ROS master; with "
                                 "`rosbag play`, leave --clock out).";
    ROS_ERROR_STREAM(sentence);
    publishers_.warn(sentence);
  }
  rival_ = others;
}

}  // namespace vibe::sim
