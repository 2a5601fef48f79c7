#pragma once
#include "vibe_firmware/core/axis.hpp"

namespace vibe_firmware {

/// What the board has read of one encoder at the beginning of a tick.
struct EncoderSample {
  std::uint32_t counter = 0;        ///< hardware counter; wraps
  bool index = false;               ///< whether the index pulse came since the last tick
  std::uint32_t index_counter = 0;  ///< the counter at that pulse
};

/// Position of a hardware counter that wraps.
struct EncoderState {
  std::int32_t count = 0;        ///< unwrapped since the start; 0 there
  std::uint32_t counter = 0;     ///< hardware counter that belongs to `count`
  std::int32_t index_count = 0;  ///< count of the first index pulse
  bool started = false;
  bool indexed = false;
  bool fault = false;  ///< stays until the device is started again
};

/// Takes one sample. The first one defines count 0. The index pulse corrects counts that were lost or gained since the
/// first one: a difference of one count is within the width of the pulse and ignored, up to an eighth of a turn is
/// corrected, more is a fault. So are a motion faster than AxisConfig::speed_limit, which is not counted, and a count
/// beyond kMaxCount.
/// @param counter_bits  after which the counter wraps, 1 to 32
/// @return counts by which the axis has moved since the last tick, correction not included
std::int32_t step(const AxisConfig& config, int counter_bits, const EncoderSample& sample, EncoderState& state);

}  // namespace vibe_firmware
