#include "vibe_firmware/core/passivity_controller.hpp"

#include <cmath>

#include "vibe_firmware/core/passivity.hpp"
#include "vibe_firmware/core/slew.hpp"

namespace vibe_firmware {
namespace {

constexpr float kReservedShare = 0.1F;  // of the capacity, for damping; design choice

/// Torque that gives at most this energy within one period. One count more than the axis can move leaves something for
/// observeChange(), so that the balance never becomes negative.
float affordableTorque(const AxisConfig& config, float energy) {
  const float motion = config.speed_limit * config.sample_period + std::fabs(config.radians_per_count);
  return energy > 0 ? energy / motion : 0.0F;
}

/// `damping` where the whole spring is allowed, the largest passive one where none is.
float substitute(const AxisConfig& config, float damping, float spring_share) {
  const float largest = maxDamping(config, 0);
  return damping < largest ? damping + (1.0F - spring_share) * (largest - damping) : damping;
}

}  // namespace

void observe(const AxisConfig& config, float torque, float motion, EnergyAccount& energy) {
  energy.add(-torque * motion, config.energy_capacity);
}

void observeChange(const AxisConfig& config, float change, EnergyAccount& energy) {
  const float half_step = 0.5F * std::fabs(config.radians_per_count);
  energy.add(-half_step * std::fabs(change), config.energy_capacity);
}

PassivityLimit limit(const AxisConfig& config, float spring, float damping, float torque_limit,
                     const EnergyAccount& energy) {
  PassivityLimit allowed{spring, damping, torque_limit, false};
  const float spring_limit = affordableTorque(config, energy.balance - kReservedShare * config.energy_capacity);
  if (std::fabs(spring) > spring_limit) {
    allowed.spring = clamp(spring, spring_limit);
    allowed.damping = substitute(config, damping, spring_limit / std::fabs(spring));
    allowed.acts = true;
  }
  const float affordable = affordableTorque(config, energy.balance);
  if (affordable < torque_limit) {
    allowed.torque = affordable;
    allowed.acts = true;
  }
  return allowed;
}

}  // namespace vibe_firmware
