#include "core/sample_report.hpp"

namespace vibe_firmware {

std::int16_t toInt16(float value, float unit) {
  constexpr float kLargest = 32767.0F;
  const float scaled = value / unit;
  if (scaled >= kLargest) return 32767;
  if (scaled <= -kLargest) return -32767;
  return static_cast<std::int16_t>(scaled < 0 ? scaled - 0.5F : scaled + 0.5F);
}

void reportEncoder(const AxisConfig& config, const EncoderState& encoder, std::size_t axis, InputReport& report) {
  const float position = static_cast<float>(encoder.count) * config.radians_per_count;
  report.axes[axis] = toInt16(position, config.full_scale / 32767.0F);
  report.counts[axis] = encoder.count;
}

std::uint8_t encoderFlags(const EncoderState& encoder, std::size_t axis) {
  const int indexed = axis == 0 ? kIndexed0 : kIndexed1;
  return static_cast<std::uint8_t>((encoder.indexed ? indexed : 0) | (encoder.fault ? kEncoderFault : 0));
}

}  // namespace vibe_firmware
