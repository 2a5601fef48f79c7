#pragma once
#include <cstdint>

#include "vibe_firmware/core/encoder.hpp"

namespace vibe::hardware {

/// A quadrature encoder with an index pulse, and the counter of a timer that reads it.
class EmulatedEncoder {
 public:
  /// @param counts_per_turn  between two index pulses; 0: without
  /// @param counter_bits     of the timer, 1 to 32
  EmulatedEncoder(std::int32_t counts_per_turn, int counter_bits)
      : counts_per_turn_(counts_per_turn), mask_(counter_bits >= 32 ? ~0U : (1U << counter_bits) - 1) {}

  /// Reads the timer. @param count  where the encoder is now
  vibe_firmware::EncoderSample sample(std::int32_t count);

 private:
  static constexpr std::int32_t kIndexCount = 700;  ///< an index pulse is here (design choice)

  std::int32_t turnOf(std::int32_t count) const;

  std::int32_t counts_per_turn_;
  std::uint32_t mask_;
  std::int32_t last_ = 0;
};

}  // namespace vibe::hardware
