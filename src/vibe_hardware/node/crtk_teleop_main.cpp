// crtk_teleop: an arm with a CRTK interface drives the scope and feels the tissue.
#include <ros/ros.h>

#include "crtk_teleop_node.hpp"
#include "vibe_ros_utils/startup.hpp"

namespace {

constexpr double kDelivery = 0.2;  // for the arm to receive that there is no force [s]

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
  return vibe::ros_utils::runNodeWithGoodbye(argc, argv, "crtk_teleop", run);
}
