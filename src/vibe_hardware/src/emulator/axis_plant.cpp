#include "vibe_hardware/emulator/axis_plant.hpp"

#include <algorithm>
#include <cmath>

namespace vibe::hardware {
namespace {

/// Torque of the current that the bridge can make at rest, at most `command`.
double drivenTorque(const AxisPlant& plant, double command) {
  if (plant.drive == Drive::Torque) return command;
  const double stall = plant.motor.torque_constant * plant.ratio * plant.motor.supply / plant.motor.resistance;
  return std::clamp(command, -stall, stall);
}

/// One substep of the midpoint rule. The mean velocity v solves
///   inertia 2 (v - velocity)/h = torque - viscous v + hand(v) - friction sign(v),
/// which is linear but for the friction.
void substep(const AxisPlant& plant, double intended_speed, double h, AxisPlantState& s) {
  const HandImpedance& hand = plant.hand;
  const double inertia = totalInertia(plant), viscous = viscousFriction(plant), coulomb = coulombFriction(plant);
  const double start = s.intended;
  s.intended += h * intended_speed;
  const double stretch = 0.5 * (start + s.intended) - s.position;
  const double drive =
      2 * inertia / h * s.velocity + s.torque + hand.stiffness * stretch + hand.damping * intended_speed;
  const double slope = 2 * inertia / h + viscous + hand.damping + 0.5 * h * hand.stiffness;
  const double friction = s.velocity == 0 ? coulomb * plant.breakaway : coulomb;
  if (std::abs(drive) <= friction) {  // stops, or stays
    s.energy.coulomb += 0.5 * inertia * s.velocity * s.velocity;
    s.velocity = 0;
    return;
  }
  const double v = (drive - std::copysign(coulomb, drive)) / slope;
  const double hand_torque = hand.stiffness * (stretch - 0.5 * h * v) + hand.damping * (intended_speed - v);
  s.energy.motor += h * v * s.torque;
  s.energy.hand += h * v * hand_torque;
  s.energy.viscous += h * viscous * v * v;
  s.energy.coulomb += h * coulomb * std::abs(v);
  s.position += h * v;
  s.velocity = 2 * v - s.velocity;
}

}  // namespace

HandImpedance handOnSlide(double mass, double damping, double stiffness, double radius) {
  const double r2 = radius * radius;
  return {mass * r2, damping * r2, stiffness * r2};
}

double viscousFriction(const AxisPlant& plant) {
  const double k = plant.motor.torque_constant * plant.ratio;
  return plant.viscous + (plant.drive == Drive::Voltage ? k * k / plant.motor.resistance : 0);
}

double coulombFriction(const AxisPlant& plant) {
  return plant.coulomb + plant.motor.friction * plant.ratio;
}

double totalInertia(const AxisPlant& plant) {
  return plant.inertia + plant.motor.inertia * plant.ratio * plant.ratio + plant.hand.inertia;
}

void step(const AxisPlant& plant, double command, double intended, double period, AxisPlantState& state) {
  const long count = std::max(1L, std::lround(period / plant.substep));
  const long delayed = std::lround(plant.output_delay / plant.substep);
  const double h = period / static_cast<double>(count);
  const double speed = (intended - state.intended) / period;
  const double torque = drivenTorque(plant, command);
  for (long i = 0; i < count; ++i) {
    if (i >= delayed) state.torque = torque;
    substep(plant, speed, h, state);
  }
  state.intended = intended;
}

std::int32_t encoderCount(const AxisPlant& plant, const AxisPlantState& state) {
  return static_cast<std::int32_t>(std::floor(state.position / plant.encoder_step));
}

double kineticEnergy(const AxisPlant& plant, const AxisPlantState& state) {
  return 0.5 * totalInertia(plant) * state.velocity * state.velocity;
}

}  // namespace vibe::hardware
