#pragma once
#include "cosim_frame.hpp"

namespace vibe_firmware {

/// Firmware in lock-step, wherever it runs.
class FirmwarePeer {
 public:
  virtual ~FirmwarePeer() = default;

  /// Runs one tick and then the main loop. @throw std::runtime_error if the firmware does not answer
  virtual CosimReply exchange(const CosimRequest& request) = 0;
};

}  // namespace vibe_firmware
