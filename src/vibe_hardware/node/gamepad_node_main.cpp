// gamepad_node: drives the scope with a gamepad or joystick.

#include <ros/ros.h>

#include <cstdio>

#include "gamepad_node.hpp"
#include "vibe_ros_utils/startup.hpp"

namespace {

constexpr int kUsage = 2;
constexpr double kMasterPatience = 10;  // [s]

}  // namespace

int main(int argc, char** argv) {
  std::setvbuf(stdout, nullptr, _IOLBF, BUFSIZ);  // the player reads what to press first, also through a pipe
  try {
    vibe::ros_utils::init(argc, argv, "gamepad_node");
    vibe::ros_utils::waitForMaster(kMasterPatience);
    ros::NodeHandle handle;
    const vibe::hardware::GamepadParameters parameters = vibe::hardware::readGamepadParameters(ros::NodeHandle("~"));
    const vibe::hardware::GamepadNode node(handle, parameters);
    ros::spin();
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "gamepad_node: %s\n", error.what());
    return kUsage;
  }
}
