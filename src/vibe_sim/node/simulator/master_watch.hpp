#pragma once

#include <atomic>
#include <string>

#include <ros/node_handle.h>
#include <ros/timer.h>

#include "publishing/publishers.hpp"

namespace vibe::sim {

/// Notices when another node publishes /clock too, which makes time jump, and when the ROS master is gone. Connections
/// between nodes outlive it, so the simulation continues until no listener is connected either.
class MasterWatch {
 public:
  /// @param timeout  how long to go on without master and listeners [s]
  MasterWatch(const ros::NodeHandle& handle, Publishers& publishers, double timeout);

  bool isHopeless() const { return hopeless_; }

 private:
  void check();
  void lookForRivalClock();

  Publishers& publishers_;
  std::string rival_;  // that was reported last
  double timeout_;
  bool was_there_ = true;
  double alone_since_ = 0;  // steady time [s]; 0: not alone
  std::atomic<bool> hopeless_{false};
  ros::WallTimer timer_;
};

}  // namespace vibe::sim
