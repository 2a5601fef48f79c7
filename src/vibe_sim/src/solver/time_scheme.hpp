#pragma once

#include "vibe_sim/solver/implicit_stepper.hpp"

namespace vibe {

/// One step of generalised-alpha (Chung, Hulbert 1993, doi 10.1115/1.2900803) or backward Euler written for one
/// unknown, the acceleration a' at the end of the step:
///   x' = x_free + x_gain a',   v' = v_free + v_gain a',   z = z_free + z_gain a'
/// where z is the point at which the forces are evaluated (between the ends of the step, and ahead by the damping
/// time). Balance: inertia (z - z_hat) = F(z) per unit mass, with the mass damping in it.
struct TimeScheme {
  explicit TimeScheme(const StepSettings& settings, double damping_rate, double damping_time);

  double h;
  double alpha_m = 0, alpha_f = 0, gamma = 1, beta = 1;
  double x_gain, v_gain, z_gain;
  double inertia;  ///< [1/s^2]
  double rate, time;

  double freeX(double x, double v, double a) const { return x + h * v + h * h * (0.5 - beta) * a * second_order; }
  double freeV(double v, double a) const { return v + h * (1 - gamma) * a; }
  /// z for a' = 0
  double freeZ(double x, double v, double a) const {
    const double x_end = freeX(x, v, a), v_end = freeV(v, a);
    return alpha_f * x + (1 - alpha_f) * x_end + time * (alpha_f * v + (1 - alpha_f) * v_end);
  }
  /// where z would be without forces
  double hatZ(double x, double v, double a) const {
    const double drag = rate * (alpha_f * v + (1 - alpha_f) * freeV(v, a));
    return freeZ(x, v, a) - (alpha_m * a + drag) / inertia;
  }

 private:
  double second_order = 1;  // 0 for backward Euler, which does not look at the old acceleration
};

}  // namespace vibe
