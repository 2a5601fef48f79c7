#pragma once
#include <string>

#include "firmware_peer.hpp"

namespace vibe_firmware {

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
