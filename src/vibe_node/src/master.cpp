#include "vibe_node/master.hpp"

#include <ros/master.h>
#include <ros/this_node.h>
#include <ros/time.h>

#include <algorithm>
#include <cstdio>
#include <string>

#include "vibe_core/common/error.hpp"

namespace vibe::node {

bool waitForMaster(double patience, const std::function<bool()>& stopped) {
  const ros::WallTime begin = ros::WallTime::now();
  bool told = false;
  while (!ros::master::check()) {
    if (stopped && stopped()) return false;
    if ((ros::WallTime::now() - begin).toSec() > patience)
      throw Error("No ROS master answers at " + ros::master::getURI() + "; start roscore, or set ROS_MASTER_URI.");
    if (!told) std::fprintf(stderr, "Waiting for a ROS master at %s ...\n", ros::master::getURI().c_str());
    told = true;
    ros::WallDuration(0.1).sleep();
  }
  return true;
}

bool asksForHelp(int argc, const char* const* argv) {
  return std::any_of(argv + 1, argv + argc,
                     [](const char* word) { return std::string(word) == "--help" || std::string(word) == "-h"; });
}

}  // namespace vibe::node
