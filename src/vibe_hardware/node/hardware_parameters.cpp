#include "hardware_parameters.hpp"

#include <ros/param.h>

#include "vibe_core/common/error.hpp"
#include "vibe_hardware/hid/hidraw_bus.hpp"
#include "vibe_hardware/hid/socket_bus.hpp"
#include "vibe_node/parameter_reader.hpp"

namespace vibe::hardware {
namespace {

constexpr const char* kHidraw = "hidraw";

}  // namespace

HardwareParameters readHardwareParameters(const ros::NodeHandle& private_handle) {
  node::ParameterReader reader(private_handle);
  HardwareParameters parameters;
  reader.read("config", parameters.config);
  reader.read("bus", parameters.bus);
  reader.read("realtime_priority", parameters.realtime_priority, 0, 99);
  double diagnostic_period = 1;  // diagnostic_updater reads it itself
  reader.read("diagnostic_period", diagnostic_period, 0.1, 60, "s");
  reader.finish();
  bool use_sim_time = false;
  ros::param::get("/use_sim_time", use_sim_time);
  if (use_sim_time) {
    throw Error(
        "Devices are sampled in wall time, but /use_sim_time is true; run 'rosparam delete /use_sim_time' before any "
        "node starts.");
  }
  return parameters;
}

std::unique_ptr<HidBus> makeBus(const std::string& bus) {
  if (bus == kHidraw) return std::make_unique<HidrawBus>();
  if (bus.find('/') != std::string::npos) return std::make_unique<SocketBus>(bus);
  throw Error("Parameter ~bus is '" + bus +
              "'; set it to hidraw or to the folder of an emulator's sockets, with a '/'.");
}

}  // namespace vibe::hardware
