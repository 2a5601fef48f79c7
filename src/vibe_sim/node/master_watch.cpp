#include "master_watch.hpp"

#include <ros/master.h>

#include "vibe_core/common/step_timer.hpp"

namespace vibe {

MasterWatch::MasterWatch(const ros::NodeHandle& handle, const Publishers& publishers, double timeout)
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
  const bool alone = !is_there && !publishers_.hasListener();
  const double now = steadyTime();
  if (!alone) alone_since_ = 0;
  if (alone && alone_since_ == 0) alone_since_ = now;
  if (alone && now - alone_since_ >= timeout_ && !hopeless_) {
    hopeless_ = true;
    ROS_ERROR_STREAM("There has been neither a ROS master nor a listener for " << timeout_ << " s; giving up.");
  }
}

}  // namespace vibe
