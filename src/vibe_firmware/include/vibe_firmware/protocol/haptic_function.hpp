#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>

#include "vibe_firmware/core/haptic_device.hpp"
#include "vibe_firmware/protocol/device_function.hpp"

namespace vibe_firmware {

/// The haptic device as a HID device. Parameters of the host wait in a mailbox for the next tick of the control
/// interrupt, which takes them over as a whole.
class HapticFunction final : public DeviceFunction<HapticConfig> {
 public:
  /// @param serial  ASCII, at most 126 characters; the text must outlive the object
  explicit HapticFunction(const HapticConfig& config, const char* serial = "0");

  /// One tick of the 1 kHz loop. @return torque of each axis [N m], to be written to the motors in the same tick
  std::array<float, kAxisCount> tick(const HapticSample& sample);

  /// The host sleeps or has left: the spring fades now instead of after the timeout; new parameters bring it back.
  void hostGone() { host_gone_.store(true, std::memory_order_relaxed); }

  /// Of the control loop. Only between two ticks.
  const HapticState& state() const { return state_; }

  std::size_t getReport(ReportType type, std::uint8_t id, std::uint8_t* bytes, std::size_t capacity) override;
  bool setReport(ReportType type, std::uint8_t id, const std::uint8_t* bytes, std::size_t size) override;

 private:
  HapticState state_;           // of the control interrupt
  ParameterReport accepted_{};  // of the main loop
  // between them
  Mailbox<ParameterReport> parameters_;
  std::atomic<bool> host_gone_{false};
};

}  // namespace vibe_firmware
