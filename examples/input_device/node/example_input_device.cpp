// Publishes a recorded stream of the device as if the device were sampling now. A driver reads from the device instead
// of a file, and stamps a sample with the time at which it was taken.
//
// usage: example_input_device FILE
#include <ros/ros.h>
#include <sensor_msgs/JointState.h>
#include <sensor_msgs/Joy.h>

#include <cstdio>
#include <fstream>

#include "vibe_example_input_device/device_stream.hpp"

namespace vibe_example {
namespace {

// [recipe]
sensor_msgs::JointState jointsOf(const DeviceSample& sample, const ros::Time& stamp) {
  sensor_msgs::JointState message;
  message.header.stamp = stamp;
  message.name = {"insertion", "rotation", "tip_up_down", "tip_left_right"};
  message.position.assign(sample.joints.begin(), sample.joints.end());
  return message;
}

sensor_msgs::Joy buttonsOf(const DeviceSample& sample, const ros::Time& stamp) {
  sensor_msgs::Joy message;
  message.header.stamp = stamp;
  message.buttons.assign(sample.buttons.begin(), sample.buttons.end());
  return message;
}

void publishAll(std::istream& device) {
  ros::NodeHandle handle;
  const ros::Publisher joints = handle.advertise<sensor_msgs::JointState>("scope/input/joint_states", 10);
  const ros::Publisher buttons = handle.advertise<sensor_msgs::Joy>("scope/buttons", 10);
  const ros::Time start = ros::Time::now();
  DeviceStream stream;
  char bytes[64];
  while (ros::ok() && (device.read(bytes, sizeof bytes) || device.gcount() > 0))
    for (const DeviceSample& sample : stream.read(reinterpret_cast<std::uint8_t*>(bytes), device.gcount())) {
      const ros::Time stamp = start + ros::Duration(DeviceStream::kPeriod * static_cast<double>(sample.number));
      ros::Time::sleepUntil(stamp);
      joints.publish(jointsOf(sample, stamp));
      buttons.publish(buttonsOf(sample, stamp));
    }
  ROS_INFO("The stream has ended; %zu frames were lost.", stream.lostFrames());
}
// [/recipe]

}  // namespace
}  // namespace vibe_example

int main(int argc, char** argv) {
  ros::init(argc, argv, "example_input_device");
  if (argc != 2) {
    std::fprintf(stderr, "usage: example_input_device FILE\n");
    return 2;
  }
  std::ifstream device(argv[1], std::ios::binary);
  if (!device) {
    std::fprintf(stderr, "example_input_device: cannot read '%s'; name a recorded stream of the device\n", argv[1]);
    return 2;
  }
  vibe_example::publishAll(device);
}
