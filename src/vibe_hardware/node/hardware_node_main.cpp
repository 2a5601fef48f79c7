// hardware_node: the haptic device and the input device as topics.

#include <ros/ros.h>

#include <csignal>
#include <cstdio>

#include "hardware_node.hpp"
#include "vibe_node/startup.hpp"

namespace {

constexpr int kUsage = 2;
constexpr double kMasterPatience = 10;  // [s]
constexpr double kDelivery = 0.2;       // for listeners to receive that the buttons are released [s]

volatile sig_atomic_t stop_signal = 0;

void onSignal(int number) {
  stop_signal = number;
}

void run() {
  ros::NodeHandle handle;
  const vibe::hardware::HardwareParameters parameters = vibe::hardware::readHardwareParameters(ros::NodeHandle("~"));
  if (parameters.realtime_priority > 0)
    for (const std::string& sentence : vibe::node::runInRealTime(parameters.realtime_priority))
      ROS_WARN_STREAM(sentence);
  vibe::hardware::HardwareNode node(handle, parameters);
  ros::AsyncSpinner spinner(1);
  spinner.start();
  while (ros::ok() && !stop_signal) ros::WallDuration(0.02).sleep();
  spinner.stop();
  if (node.stop()) ros::WallDuration(kDelivery).sleep();
}

}  // namespace

int main(int argc, char** argv) {
  try {
    // roscpp's own handler would close the topics before the buttons are released
    vibe::node::init(argc, argv, "hardware_node", ros::init_options::NoSigintHandler);
    signal(SIGINT, onSignal);
    signal(SIGTERM, onSignal);
    if (!vibe::node::waitForMaster(kMasterPatience, [] { return stop_signal != 0; })) return 0;
    run();
    ros::shutdown();
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "hardware_node: %s\n", error.what());
    return kUsage;
  }
}
