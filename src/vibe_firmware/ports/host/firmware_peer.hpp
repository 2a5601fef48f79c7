#pragma once

#include <string>

#include "cosim_frame.hpp"
#include "cosim_target.hpp"
#include "vibe_firmware/hal/application.hpp"
#include "vibe_firmware/protocol/haptic_function.hpp"

namespace vibe_firmware {

/// Firmware in lock-step, wherever it runs.
class FirmwarePeer {
 public:
  virtual ~FirmwarePeer() = default;

  /// Runs one tick and then the main loop. @throw std::runtime_error if the firmware does not answer
  virtual CosimReply exchange(const CosimRequest& request) = 0;
};

/// The firmware of the haptic device, compiled for this machine.
class LocalPeer : public FirmwarePeer {
 public:
  CosimReply exchange(const CosimRequest& request) override {
    target_.begin(request);
    application_.tick();
    const CosimReply reply = target_.end();
    application_.poll();
    return reply;
  }

 private:
  HapticFunction device_{HapticConfig{}};
  CosimTarget target_{device_.state()};
  Application<HapticFunction> application_{target_, target_, device_};
};

/// Firmware in an emulator, through two FIFOs.
class FifoPeer : public FirmwarePeer {
 public:
  /// Opens both, in the order in which the firmware does.
  /// @throw std::runtime_error if a FIFO cannot be opened or the firmware does not open it within 30 s
  FifoPeer(const std::string& replies, const std::string& requests);
  FifoPeer(const FifoPeer&) = delete;
  FifoPeer& operator=(const FifoPeer&) = delete;
  ~FifoPeer() override;  ///< asks the firmware to end

  CosimReply exchange(const CosimRequest& request) override;

 private:
  void send(const CosimRequest& request);

  int replies_ = -1;
  int requests_ = -1;
};

}  // namespace vibe_firmware
