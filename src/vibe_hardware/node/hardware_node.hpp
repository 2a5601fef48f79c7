#pragma once

#include <memory>
#include <mutex>
#include <optional>
#include <string>

#include <ros/node_handle.h>
#include <ros/ros.h>

#include "hardware_messages.hpp"
#include "vibe_hardware/driver/polling.hpp"
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

/// Both devices as topics: docs/interfaces.md. One thread per device; callbacks of ROS come from one thread of a
/// spinner, which must have been stopped before stop() or the end.
class HardwareNode {
 public:
  /// @throws Error for a wrong calibration or bus
  HardwareNode(ros::NodeHandle handle, const HardwareParameters& parameters);
  ~HardwareNode();
  HardwareNode(const HardwareNode&) = delete;
  HardwareNode& operator=(const HardwareNode&) = delete;

  /// Lets go of the devices and releases the buttons. @return whether any was pressed
  bool stop();

 private:
  std::mutex mutex_;  // of everything that more than one thread uses, down to the buses
  ScopeJoints joints_;
  ScopeButtons buttons_;
  std::optional<SuturingDeviceDrive> suturing_device_;
  std::array<DeviceStatistics, kDeviceKinds> device_statistics_;
  HapticStatistics haptic_statistics_;
  std::array<SilenceWatch, kDeviceKinds> silence_;
  std::uint64_t rejected_ = 0;
  double last_buttons_ = -1;         // time of the last message [s]
  double last_suturing_device_ = 0;  // time of the last motion [s]
  double camera_time_ = -1e9;  // arrival of the last message of another node on suturing_device/input/joint_states [s]
  std::string operating_state_;
  bool was_homed_ = false;
  StampSource scope_stamps_, haptic_stamps_, button_stamps_, suturing_device_stamps_;

  std::unique_ptr<HidBus> haptic_bus_, input_bus_;
  HapticDriver haptic_;
  DeviceDriver input_;
  double next_statistics_[kDeviceKinds] = {};

  ros::Publisher scope_publisher_, button_publisher_, haptic_publisher_, state_publisher_, suturing_device_publisher_;
  ros::Subscriber parameters_subscriber_, suturing_device_subscriber_;
  diagnostic_updater::Updater updater_;
  std::array<DiagnosticMemory, kDeviceKinds> memory_;
  ros::WallTimer timer_;
  std::unique_ptr<PollingThread> haptic_thread_, input_thread_;

  DeviceDriver::Callbacks callbacksOf(DeviceKind kind);
  void advertise(ros::NodeHandle& handle);
  void startThreads();
  void storeStatistics(DeviceKind kind, const DeviceDriver& device);
  void onSample(DeviceKind kind, const DeviceSample& sample);
  void onLost(DeviceKind kind, double now);
  void watchSilence(DeviceKind kind);
  void publishJoints(DeviceKind kind, double time);
  void publishButtons(double time, bool changed);
  void publishSuturingDevice(double time);
  void publishState();
  void onParameters(const vibe_msgs::HapticParameters& message);
  void onSuturingDevice(const ros::MessageEvent<const sensor_msgs::JointState>& event);
};

}  // namespace vibe::hardware
