#include "vibe_hardware/emulator/emulated_arm.hpp"

namespace vibe::hardware {

void stepArm(const EmulatedArmConfig& config, double dt, const Eigen::Vector3d& force, const Eigen::Vector3d& torque,
             const HandIntent& intent, EmulatedArmState& state) {
  const Eigen::Vector3d pull =
      config.hand_stiffness * (intent.position - state.position) - config.hand_damping * state.velocity;
  state.velocity += dt / config.mass * (force + pull);
  const Eigen::Vector3d way = dt * state.velocity;
  state.position += way;
  const Eigen::Vector3d twist = config.turn_stiffness * (intent.turn - state.turn) - config.turn_damping * state.spin;
  state.spin += dt / config.inertia * (torque + twist);
  const Eigen::Vector3d angle = dt * state.spin;
  state.turn += angle;
  state.given += force.dot(way) + torque.dot(angle);
}

Eigen::Quaterniond orientationOf(const EmulatedArmState& state) {
  const double angle = state.turn.norm();
  if (angle < 1e-12) return Eigen::Quaterniond::Identity();
  return Eigen::Quaterniond(Eigen::AngleAxisd(angle, state.turn / angle));
}

}  // namespace vibe::hardware
