// gamepad_node: drives the scope with a gamepad or joystick.

#include <ros/ros.h>

#include <cstdio>

#include "gamepad_node.hpp"
#include "vibe_node/master.hpp"

namespace {

constexpr int kUsage = 2;
constexpr double kMasterPatience = 10;  // [s]

}  // namespace

int main(int argc, char** argv) {
  std::setvbuf(stdout, nullptr, _IOLBF, BUFSIZ);  // the player reads what to press first, also through a pipe
  try {
    ros::init(argc, argv, "gamepad_node");
    vibe::waitForMaster(kMasterPatience);
    ros::NodeHandle handle;
    const vibe::GamepadParameters parameters = vibe::readGamepadParameters(ros::NodeHandle("~"));
    const vibe::GamepadNode node(handle, parameters);
    ros::spin();
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "gamepad_node: %s\n", error.what());
    return kUsage;
  }
}
