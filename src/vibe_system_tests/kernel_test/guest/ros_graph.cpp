#include "ros_graph.hpp"

#include <ros/callback_queue.h>

#include <cstdlib>
#include <stdexcept>

#include "statistics.hpp"

namespace vibe::hardware {
namespace {

constexpr double kMasterTimeout = 120;  // [s]; Python starts slowly in an emulated processor

}  // namespace

RosGraph::Connection::Connection() {
  if (ros::isInitialized()) return;
  ros::init(ros::M_string{}, "hid_guest", ros::init_options::NoSigintHandler);
  const double end = now() + kMasterTimeout;
  while (!ros::master::check()) {
    if (now() > end) throw std::runtime_error("rosmaster does not answer; see rosmaster.log");
    ros::WallDuration(0.1).sleep();
  }
}

RosGraph::RosGraph() = default;

std::unique_ptr<ChildProcess> RosGraph::start(const std::string& node, const std::vector<std::string>& parameters) {
  const char* devel = std::getenv("VIBE_DEVEL");
  if (!devel) throw std::runtime_error("VIBE_DEVEL is not set; run scripts/hid_kernel");
  std::vector<std::string> command{std::string(devel) + "/lib/vibe_hardware/" + node};
  command.insert(command.end(), parameters.begin(), parameters.end());
  return std::make_unique<ChildProcess>(command);
}

bool RosGraph::waitUntil(const std::function<bool()>& condition, double timeout) {
  const double end = now() + timeout;
  while (!condition()) {
    if (now() > end) return false;
    ros::getGlobalCallbackQueue()->callAvailable(ros::WallDuration(0.01));
  }
  return true;
}

}  // namespace vibe::hardware
