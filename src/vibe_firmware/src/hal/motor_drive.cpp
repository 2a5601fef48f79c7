#include "vibe_firmware/hal/motor_drive.hpp"

namespace vibe_firmware {

float dutyOf(const MotorDrive& drive, float torque) {
  const float stall = drive.supply_voltage * drive.torque_constant * drive.transmission / drive.resistance;
  const float duty = drive.direction * torque / stall;
  if (duty > 1.0F) return 1.0F;
  if (duty < -1.0F) return -1.0F;
  return duty == duty ? duty : 0.0F;  // NaN is not equal to itself
}

BridgeInputs slowDecay(float duty, std::uint32_t period) {
  const float amount = duty < 0 ? -duty : duty;
  const auto driven = static_cast<std::uint32_t>(amount * static_cast<float>(period) + 0.5F);
  const std::uint32_t braked = driven < period ? period - driven : 0;
  return duty < 0 ? BridgeInputs{braked, period} : BridgeInputs{period, braked};
}

}  // namespace vibe_firmware
