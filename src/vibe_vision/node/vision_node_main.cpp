// vision_node: the instruments in the image of a camera, as topics and datagrams.

#include <ros/ros.h>

#include <csignal>

#include "vibe_ros_utils/startup.hpp"
#include "vision_node.hpp"

namespace {

/// As roscpp does on SIGINT, so that the camera is let go.
void onSignal(int) {
  ros::requestShutdown();
}

}  // namespace

int main(int argc, char** argv) {
  return vibe::ros_utils::runNode(argc, argv, "vision_node", [] {
    ros::NodeHandle handle, private_handle("~");
    const vibe::vision::VisionParameters parameters = vibe::vision::readVisionParameters(private_handle);
    signal(SIGTERM, onSignal);
    vibe::vision::VisionNode node(handle, private_handle, ros::this_node::getName(), parameters);
    ros::spin();
  });
}
