#pragma once
#include "cosim_frame.hpp"

namespace vibe_firmware {

/// Remembers what the input reports of a run have said.
class ReportWatch {
 public:
  void receive(const CosimReply& reply) {
    if (reply.has_report == 0 || !unpack(reply.report, sizeof reply.report, last_)) return;
    flags_ = static_cast<std::uint8_t>(flags_ | last_.flags);
  }

  std::uint8_t flagsSeen() const { return flags_; }

  /// The firmware has taken the parameters with this number, and neither refused nor cut them.
  bool parametersInForce(std::uint16_t number) const {
    return last_.parameter_number == number && !(last_.flags & kHostSilent) &&
           !(flags_ & (kRefused | kPassivityActs | kEncoderFault));
  }

 private:
  InputReport last_;
  std::uint8_t flags_ = 0;
};

}  // namespace vibe_firmware
