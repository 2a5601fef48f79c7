#pragma once
#include <ros/node_handle.h>

#include <memory>
#include <string>

#include "vibe_hardware/hid/hid_port.hpp"

namespace vibe::hardware {

/// Private parameters of hardware_node.
struct HardwareParameters {
  std::string config = "package://vibe_hardware/config/devices.yaml";
  std::string bus = "hidraw";  ///< or the folder of an emulator's sockets
  int realtime_priority = 0;   ///< of all threads, SCHED_FIFO; 0: ordinary threads
};

/// @throws Error for a parameter that is unknown or wrong
HardwareParameters readHardwareParameters(const ros::NodeHandle& private_handle);

/// @param bus  "hidraw", or a folder
std::unique_ptr<HidBus> makeBus(const std::string& bus);

}  // namespace vibe::hardware
