#pragma once
#include "cosim_target.hpp"
#include "firmware_peer.hpp"
#include "vibe_firmware/hal/application.hpp"
#include "vibe_firmware/protocol/haptic_function.hpp"

namespace vibe_firmware {

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

}  // namespace vibe_firmware
