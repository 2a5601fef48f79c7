#pragma once
#include "cosim_frame.hpp"
#include "vibe_firmware/core/haptic_device.hpp"
#include "vibe_firmware/hal/board.hpp"
#include "vibe_firmware/hal/motor_drive.hpp"

namespace vibe_firmware {

/// Board and USB link of firmware that runs in lock-step with a plant: input comes from a request, output goes into a
/// reply. The same code runs in QEMU and on the host; only who carries the frames differs.
class CosimTarget final : public Board, public UsbLink {
 public:
  explicit CosimTarget(const HapticState& state) : state_(state) {}

  /// Before and after Application::tick().
  void begin(const CosimRequest& request) { request_ = request; }
  CosimReply end();

  HapticSample sample() override;
  void writeTorque(const std::array<float, kAxisCount>& torque) override;
  void feedWatchdog() override {}
  void poll(ControlHandler& handler) override;
  bool sendReport(const std::uint8_t* bytes, std::size_t size) override;

 private:
  const HapticState& state_;
  MotorDrive drive_;
  CosimRequest request_;
  CosimReply reply_;
};

}  // namespace vibe_firmware
