#pragma once

#include <vector>

#include "vibe_core/solver/elastic_body.hpp"
#include "vibe_core/solver/implicit_stepper.hpp"

namespace vibe {

/// One step of generalised-alpha (Chung, Hulbert 1993, doi 10.1115/1.2900803) or backward Euler written for one
/// unknown, the acceleration a' at the end of the step:
///   x' = x_free + x_gain a',   v' = v_free + v_gain a',   z = z_free + z_gain a'
/// where z is the point at which the forces are evaluated (between the ends of the step, and ahead by the damping
/// time). Balance: inertia (z - z_hat) = F(z) per unit mass, with the mass damping in it.
struct TimeScheme {
  explicit TimeScheme(const StepSettings& settings, double mass_damping, double stiffness_damping);

  double h;
  double alpha_m = 0, alpha_f = 0, gamma = 1, beta = 1;
  double x_gain, v_gain, z_gain;
  double inertia;  ///< [1/s^2]
  /// Part of the step after which the forces act.
  double part() const { return 1 - alpha_f; }
  double rate, time;

  /// a * acceleration + v * velocity + position
  struct Blend {
    double v, a;
    double operator()(double x, double vel, double acc) const { return x + v * vel + a * acc; }
  };
  Blend free_x;     ///< x' for a' = 0
  Blend free_z;     ///< z for a' = 0
  Blend hat_z;      ///< where z would be without forces
  double free_v_a;  ///< v' for a' = 0 is v + free_v_a a
};

/// Moves a free body rigidly by what its velocities and accelerations make of it: however far, that does not strain.
/// The translation and the turn have the linear and angular momentum of the nodes' own moves.
/// @param z  positions, 4 numbers per node, in and out [m]
void moveRigidly(const ElasticBody& body, const MotionView& motion, const TimeScheme& scheme, std::vector<double>& z);

}  // namespace vibe
