#include "time_scheme.hpp"

namespace vibe {

TimeScheme::TimeScheme(const StepSettings& settings, double damping_rate, double damping_time)
    : h(settings.step), rate(damping_rate), time(damping_time) {
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
}

}  // namespace vibe
