// latency_probe: writes when a joint that blinks passed each stage from a device to the screen. See scripts/latency.

#include <ros/ros.h>

#include <cstdio>

#include "latency_probe.hpp"
#include "vibe_ros_utils/parameter_reader.hpp"
#include "vibe_ros_utils/startup.hpp"

namespace {

constexpr char kHelp[] =
    "latency_probe: writes when a joint that blinks passed each stage from a device to the screen.\n"
    "Usage: rosrun vibe_latency latency_probe _folder:=DIR [_PARAMETER:=VALUE]...\n"
    "Parameters: folder, joint, device, state, screen; see docs/latency.md.\n";

constexpr double kFlushPeriod = 0.5;  // [s]

void run() {
  ros::NodeHandle handle;
  vibe::latency::LatencyProbe probe(handle, vibe::latency::readProbeParameters(ros::NodeHandle("~")));
  ros::AsyncSpinner spinner(1);
  spinner.start();
  bool announced = false;
  while (ros::ok() && vibe::ros_utils::stopSignal() == 0) {
    ros::WallDuration(kFlushPeriod).sleep();
    probe.flush();
    if (!announced && probe.seesLamp()) std::puts("latency_probe: ready");
    announced = announced || probe.seesLamp();
    std::fflush(stdout);
  }
  spinner.stop();
  probe.flush();
}

}  // namespace

int main(int argc, char** argv) {
  return vibe::ros_utils::runNodeWithGoodbye(argc, argv, "latency_probe", run, kHelp);
}
