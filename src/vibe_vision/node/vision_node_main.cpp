// vision_node: the instruments in the image of a camera, as topics and datagrams.

#include <ros/ros.h>

#include <csignal>
#include <cstdio>

#include "vibe_ros_utils/startup.hpp"
#include "vision_node.hpp"

namespace {

constexpr int kUsage = 2;
constexpr double kMasterPatience = 10;  // [s]

/// As roscpp does on SIGINT, so that the camera is let go.
void onSignal(int) {
  ros::requestShutdown();
}

}  // namespace

int main(int argc, char** argv) {
  try {
    vibe::ros_utils::init(argc, argv, "vision_node");
    vibe::ros_utils::waitForMaster(kMasterPatience);
    ros::NodeHandle handle, private_handle("~");
    const vibe::vision::VisionParameters parameters = vibe::vision::readVisionParameters(private_handle);
    signal(SIGTERM, onSignal);
    vibe::vision::VisionNode node(handle, private_handle, ros::this_node::getName(), parameters);
    ros::spin();
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "vision_node: %s\n", error.what());
    return kUsage;
  }
}
