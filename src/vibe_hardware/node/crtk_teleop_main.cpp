// crtk_teleop: an arm with a CRTK interface drives the scope and feels the tissue.

#include <ros/ros.h>

#include <cstdio>

#include "crtk_teleop_node.hpp"
#include "vibe_node/startup.hpp"

namespace {

constexpr int kUsage = 2;
constexpr double kMasterPatience = 10;  // [s]

}  // namespace

int main(int argc, char** argv) {
  try {
    vibe::node::init(argc, argv, "crtk_teleop");
    vibe::node::waitForMaster(kMasterPatience);
    ros::NodeHandle handle;
    const vibe::hardware::CrtkParameters parameters = vibe::hardware::readCrtkParameters(ros::NodeHandle("~"));
    vibe::hardware::CrtkTeleopNode node(handle, parameters);
    ros::spin();
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "crtk_teleop: %s\n", error.what());
    return kUsage;
  }
}
