// crtk_teleop: an arm with a CRTK interface drives the scope and feels the tissue.

#include <ros/ros.h>

#include <cstdio>

#include "crtk_teleop_node.hpp"
#include "vibe_ros_utils/startup.hpp"

namespace {

constexpr int kUsage = 2;
constexpr double kMasterPatience = 10;  // [s]
constexpr double kDelivery = 0.2;       // for the arm to receive that there is no force [s]

void run() {
  ros::NodeHandle handle;
  const vibe::hardware::CrtkParameters parameters = vibe::hardware::readCrtkParameters(ros::NodeHandle("~"));
  vibe::hardware::CrtkTeleopNode node(handle, parameters);
  ros::AsyncSpinner spinner(1);
  spinner.start();
  vibe::ros_utils::waitForStop();
  spinner.stop();
  node.release();
  ros::WallDuration(kDelivery).sleep();
}

}  // namespace

int main(int argc, char** argv) {
  try {
    vibe::ros_utils::initWithGoodbye(argc, argv, "crtk_teleop");
    if (!vibe::ros_utils::waitForMaster(kMasterPatience)) return 0;
    run();
    ros::shutdown();
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "crtk_teleop: %s\n", error.what());
    return kUsage;
  }
}
