#pragma once
#include "vibe_firmware/core/sample.hpp"
#include "vibe_firmware/protocol/reports.hpp"

// Parts of the input report that both devices have.

namespace vibe_firmware {

/// Nearest integer, limited to +-32767; value / unit must be finite.
std::int16_t toInt16(float value, float unit);

/// Position and count of one axis.
void reportEncoder(const AxisConfig& config, const EncoderState& encoder, std::size_t axis, InputReport& report);

/// kIndexed0, kIndexed1 and kEncoderFault.
std::uint8_t encoderFlags(const EncoderState& encoder, std::size_t axis);

}  // namespace vibe_firmware
