// hardware_node: the haptic device and the input device as topics.

#include <ros/ros.h>

#include <cstdio>

#include "hardware_node.hpp"
#include "vibe_ros_utils/startup.hpp"

namespace {

constexpr int kUsage = 2;
constexpr double kMasterPatience = 10;  // [s]
constexpr double kDelivery = 0.2;       // for listeners to receive that the buttons are released [s]

void run() {
  ros::NodeHandle handle;
  const vibe::hardware::HardwareParameters parameters = vibe::hardware::readHardwareParameters(ros::NodeHandle("~"));
  if (parameters.realtime_priority > 0)
    for (const std::string& sentence : vibe::ros_utils::runInRealTime(parameters.realtime_priority))
      ROS_WARN_STREAM(sentence);
  vibe::hardware::HardwareNode node(handle, parameters);
  ros::AsyncSpinner spinner(1);
  spinner.start();
  vibe::ros_utils::waitForStop();
  spinner.stop();
  if (node.stop()) ros::WallDuration(kDelivery).sleep();
}

}  // namespace

int main(int argc, char** argv) {
  try {
    vibe::ros_utils::initWithGoodbye(argc, argv, "hardware_node");
    if (!vibe::ros_utils::waitForMaster(kMasterPatience)) return 0;
    run();
    ros::shutdown();
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "hardware_node: %s\n", error.what());
    return kUsage;
  }
}
