#pragma once
#include <array>
#include <memory>
#include <string>

#include "vibe_firmware/protocol/reports.hpp"
#include "vibe_hardware/hid/hid_port.hpp"
#include "vibe_hardware/hid/report_descriptor.hpp"

namespace vibe::hardware {

/// An open device whose protocol has been checked, and its feature reports. Not thread-safe.
class DeviceConnection {
 public:
  /// Reads and checks report descriptor, status and configuration.
  /// @throws Error with the remedy if it is not a device of this release; DeviceGone
  DeviceConnection(std::unique_ptr<HidPort> port, const HidInfo& info, DeviceKind kind);

  const HidInfo& info() const { return info_; }  ///< as the bus listed it
  /// Resolution, friction and limits of both axes, read and checked once when the device was opened.
  const std::array<vibe_firmware::AxisConfig, vibe_firmware::kAxisCount>& axes() const { return axes_; }
  const vibe_firmware::StatusReport& status() const { return status_; }  ///< as read last
  std::string firmwareVersion() const;                                   ///< "1.2.3"

  /// Waits for an input report. @return its size; 0: none came in time  @throws DeviceGone
  std::size_t read(std::uint8_t* bytes, std::size_t capacity, double timeout) {
    return port_->read(bytes, capacity, timeout);
  }

  /// Reads status() anew. @throws DeviceGone; Error if the device does not answer, or not as the protocol says
  void refreshStatus();
  /// The set of parameters that the device holds. @throws DeviceGone; Error as refreshStatus()
  vibe_firmware::ParameterReport readParameters();
  /// Sends a set of parameters. Whether the device takes it over or refuses its values shows in later reports and in
  /// the status. @throws DeviceGone; Error if the device rejects the form, or does not answer
  void sendParameters(const vibe_firmware::ParameterReport& parameters);

 private:
  std::unique_ptr<HidPort> port_;
  HidInfo info_;
  DeviceKind kind_;
  vibe_firmware::StatusReport status_{};
  std::array<vibe_firmware::AxisConfig, vibe_firmware::kAxisCount> axes_{};

  template <class Report, std::size_t Size>
  void get(std::uint8_t id, const char* name, Report& report);
  void readAxis(int axis);
};

/// One sentence on why a set of parameters was refused, with the numbers that were compared.
std::string describe(const vibe_firmware::Verdict& verdict);

}  // namespace vibe::hardware
