// hardware_node: the haptic device and the input device as topics.

#include <ros/ros.h>

#include <cstdio>

#include "hardware_node.hpp"

namespace {

constexpr int kUsage = 2;

}  // namespace

int main(int argc, char** argv) {
  try {
    ros::init(argc, argv, "hardware_node");
    ros::NodeHandle handle;
    const vibe::HardwareParameters parameters = vibe::readHardwareParameters(ros::NodeHandle("~"));
    const vibe::HardwareNode node(handle, parameters);
    ros::spin();
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "hardware_node: %s\n", error.what());
    return kUsage;
  }
}
