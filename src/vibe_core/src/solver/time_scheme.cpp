#include "solver/time_scheme.hpp"

namespace vibe {

TimeScheme::TimeScheme(const StepSettings& settings, double mass_damping, double stiffness_damping)
    : h(settings.step), rate(mass_damping), time(stiffness_damping) {
  double second_order = 1;  // backward Euler does not look at the old acceleration
  if (settings.backward_euler) {
    second_order = 0;
  } else {
    const double r = settings.spectral_radius;
    alpha_m = (2 * r - 1) / (r + 1);
    alpha_f = r / (r + 1);
    gamma = 0.5 - alpha_m + alpha_f;
    beta = 0.25 * (1 - alpha_m + alpha_f) * (1 - alpha_m + alpha_f);
  }
  x_gain = h * h * beta;
  v_gain = h * gamma;
  z_gain = (1 - alpha_f) * (x_gain + time * v_gain);
  inertia = ((1 - alpha_m) + rate * (1 - alpha_f) * v_gain) / z_gain;
  free_v_a = h * (1 - gamma);
  free_x = {h, h * h * (0.5 - beta) * second_order};
  free_z = {(1 - alpha_f) * free_x.v + time, (1 - alpha_f) * (free_x.a + time * free_v_a)};
  hat_z = {free_z.v - rate / inertia, free_z.a - (alpha_m + rate * (1 - alpha_f) * free_v_a) / inertia};
}

}  // namespace vibe
