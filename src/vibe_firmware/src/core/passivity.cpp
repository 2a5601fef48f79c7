#include "vibe_firmware/core/passivity.hpp"

#include <cmath>

#include "vibe_firmware/core/axis_control.hpp"

namespace vibe_firmware {

void EnergyAccount::add(float energy, float capacity) {
  const float term = energy + error;
  const float sum = balance + term;
  const float part = sum - balance;
  error = (balance - (sum - part)) + (term - part);
  balance = sum;
  if (balance < capacity) return;
  balance = capacity;
  error = 0;
}

namespace {

constexpr float kRoundingMargin = 1.0F - 1e-5F;  // so that validate() accepts what maxStiffness() returns

float filterFactor(const AxisConfig& config) {
  return (1.0F - config.velocity_pole) / (1.0F + config.velocity_pole);
}

/// Largest error of the filtered velocity, times T / D: that of a step of the encoder that comes at the worst time.
float quantisationFactor(const AxisConfig& config) {
  return 1.0F - config.velocity_pole;
}

float stepSize(const AxisConfig& config) {
  return std::fabs(config.radians_per_count);
}

/// h: how much more viscous friction the delay of the torque needs.
float delayFactor(const AxisConfig& config) {
  const float delay = config.output_delay / config.sample_period;
  return 0.5F + delay + std::sqrt(0.25F + 2.0F * delay);
}

/// Viscous friction needed per stiffness [s].
float holdTime(const AxisConfig& config) {
  return 0.5F * config.sample_period;
}

float smaller(float a, float b) {
  return a < b ? a : b;
}
float atLeastZero(float value) {
  return value > 0 ? value : 0.0F;
}

bool finite(const AxisParameters& p) {
  return std::isfinite(p.stiffness) && std::isfinite(p.damping) && std::isfinite(p.position) &&
         std::isfinite(p.torque) && std::isfinite(p.torque_limit);
}

Verdict refuse(Refusal refusal, float value, float limit) {
  return {refusal, 0, value, limit};
}

/// Signs and sizes of the single values.
Verdict checkRanges(const AxisConfig& config, const AxisParameters& p) {
  if (p.stiffness < 0) return refuse(Refusal::Negative, p.stiffness, 0);
  if (p.damping < 0) return refuse(Refusal::Negative, p.damping, 0);
  if (p.torque_limit < 0) return refuse(Refusal::Negative, p.torque_limit, 0);
  if (p.torque_limit > config.torque_limit) return refuse(Refusal::TorqueLimit, p.torque_limit, config.torque_limit);
  if (std::fabs(p.torque) > config.torque_limit) return refuse(Refusal::TorqueLimit, p.torque, config.torque_limit);
  const float farthest = static_cast<float>(kMaxCount) * stepSize(config);
  if (std::fabs(p.position) > farthest) return refuse(Refusal::Position, p.position, farthest);
  return {};
}

}  // namespace

float requiredViscousFriction(const AxisConfig& config, float stiffness, float damping) {
  return config.safety_factor * delayFactor(config) * (stiffness * holdTime(config) + filterFactor(config) * damping);
}

float requiredCoulombFriction(const AxisConfig& config, float stiffness, float damping) {
  return config.safety_factor * stepSize(config) *
         (0.5F * stiffness + quantisationFactor(config) * damping / config.sample_period);
}

float maxStiffness(const AxisConfig& config, float damping) {
  const float margin = kRoundingMargin / config.safety_factor;
  const float viscous =
      (config.viscous_friction * margin / delayFactor(config) - filterFactor(config) * damping) / holdTime(config);
  const float coulomb = 2.0F * (config.coulomb_friction * margin / stepSize(config) -
                                quantisationFactor(config) * damping / config.sample_period);
  return atLeastZero(smaller(viscous, coulomb));
}

float maxDamping(const AxisConfig& config, float stiffness) {
  const float margin = kRoundingMargin / config.safety_factor;
  const float viscous =
      (config.viscous_friction * margin / delayFactor(config) - stiffness * holdTime(config)) / filterFactor(config);
  const float coulomb = (config.coulomb_friction * margin / stepSize(config) - 0.5F * stiffness) *
                        config.sample_period / quantisationFactor(config);
  return atLeastZero(smaller(viscous, coulomb));
}

Verdict validate(const AxisConfig& config, const AxisParameters& parameters) {
  if (!finite(parameters)) return refuse(Refusal::NotFinite, 0, 0);
  const Verdict ranges = checkRanges(config, parameters);
  if (ranges.refusal != Refusal::None) return ranges;
  const float viscous = requiredViscousFriction(config, parameters.stiffness, parameters.damping);
  if (viscous > 0 && !(config.viscous_friction > viscous))
    return refuse(Refusal::ViscousFriction, viscous, config.viscous_friction);
  const float coulomb = requiredCoulombFriction(config, parameters.stiffness, parameters.damping);
  if (!(config.coulomb_friction >= coulomb)) return refuse(Refusal::CoulombFriction, coulomb, config.coulomb_friction);
  return {};
}

Verdict validate(const std::array<AxisConfig, kAxisCount>& configs,
                 const std::array<AxisParameters, kAxisCount>& parameters) {
  for (std::size_t axis = 0; axis < kAxisCount; ++axis) {
    Verdict verdict = validate(configs[axis], parameters[axis]);
    verdict.axis = static_cast<std::uint8_t>(axis);
    if (verdict.refusal != Refusal::None) return verdict;
  }
  return {};
}

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
