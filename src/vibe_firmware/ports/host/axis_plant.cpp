#include "axis_plant.hpp"

#include <algorithm>
#include <cmath>

namespace vibe_firmware {
namespace {

constexpr double kPeriod = 1e-3;
constexpr int kSubsteps = 50;

}  // namespace

void AxisPlant::advance(double duty, double hand) {
  const std::int32_t before = count();
  for (int i = 0; i < kSubsteps; ++i) substep(duty, hand, kPeriod / kSubsteps);
  noteIndex(before);
}

void AxisPlant::substep(double duty, double hand, double dt) {
  const MotorDrive& drive = config_.drive;
  const double stall = drive.supply_voltage * drive.torque_constant * drive.transmission / drive.resistance;
  const double torque = stall * duty - backEmfFriction() * velocity_ + hand;
  const double free = velocity_ + dt * torque / config_.inertia;
  const double stopping = dt * config_.coulomb_friction / config_.inertia;
  const double next = std::copysign(std::max(std::abs(free) - stopping, 0.0), free);
  position_ += 0.5 * dt * (velocity_ + next);
  velocity_ = next;
}

void AxisPlant::moveTo(double position) {
  const std::int32_t before = count();
  velocity_ = (position - position_) / kPeriod;
  position_ = position;
  noteIndex(before);
}

double AxisPlant::backEmfFriction() const {
  const double constant = static_cast<double>(config_.drive.transmission) * config_.drive.torque_constant;
  return constant * constant / config_.drive.resistance;
}

std::int32_t AxisPlant::count() const {
  return static_cast<std::int32_t>(std::floor(position_ / config_.radians_per_count + 0.5));
}

void AxisPlant::noteIndex(std::int32_t before) {
  const auto turn = [this](std::int32_t c) {
    return static_cast<std::int32_t>(std::floor(static_cast<double>(c) / config_.counts_per_turn));
  };
  const std::int32_t later = std::max(turn(before), turn(count()));
  index_ = turn(before) != turn(count());
  if (index_) index_count_ = static_cast<std::uint32_t>(later * config_.counts_per_turn);
}

}  // namespace vibe_firmware
