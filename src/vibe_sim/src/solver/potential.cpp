#include "potential.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "vibe_sim/solver/energy_term.hpp"
#include "vibe_sim/tissue/shell.hpp"

namespace vibe {

namespace {
constexpr double kRounding = 6e-8;  // of single precision, relative
}

double Potential::evaluate(const std::vector<double>& z, std::vector<float>& gradient) {
  const int n = body_.nodeCount();
  float* u = scratch_.displacement.data();
  for (int i = 0; i < n; ++i)
    for (int k = 0; k < 3; ++k) u[4 * i + k] = static_cast<float>(z[4 * i + k] - body_.rest[i][k]);
  std::fill(gradient.begin(), gradient.end(), 0.0F);
  double value = 0;
  const int pieces = body_.elements->pieceCount();
  if (gas_.control != GasLoad::Control::None) {
    std::fill(scratch_.volume_gradient.begin(), scratch_.volume_gradient.end(), 0.0F);
    scratch_.volume = 0;
    for (int p = 0; p < pieces; ++p) {
      double volume = 0;
      value += body_.shell->evaluate(p, u, gradient.data(), scratch_.volume_gradient.data(), volume);
      scratch_.volume += volume;
    }
    elastic_ = value;
    noise_ = 1e-6 * std::abs(value);
    value += gasEnergy();
    const auto p = static_cast<float>(scratch_.pressure);
    for (std::size_t i = 0; i < gradient.size(); ++i) gradient[i] -= p * scratch_.volume_gradient[i];
  } else {
    for (int p = 0; p < pieces; ++p) value += body_.elements->evaluate(p, u, gradient.data());
    elastic_ = value;
    noise_ = 1e-6 * std::abs(value);
  }
  if (extra_ != nullptr) value += extra_->evaluate(z.data(), gradient.data());
  return value + addBodyTerms(z, gradient);
}

double Potential::gasEnergy() {
  switch (gas_.control) {
    case GasLoad::Control::Amount: {
      const double volume = std::max(scratch_.volume, 1e-12);
      scratch_.pressure = gas_.amount / volume - gas_.ambient;
      noise_ += 1e-7 * std::abs(scratch_.pressure) * volume;
      return gas_.ambient * (volume - gas_.volume) - gas_.amount * std::log(volume / std::max(gas_.volume, 1e-12));
    }
    default:  // a prescribed pressure, or the force that holds a prescribed volume
      scratch_.pressure = gas_.pressure;
      noise_ += 1e-7 * std::abs(scratch_.pressure * scratch_.volume);
      return -gas_.pressure * (scratch_.volume - gas_.volume);
  }
}

double Potential::gasStiffness() const {
  if (gas_.control == GasLoad::Control::Amount) return gas_.amount / (scratch_.volume * scratch_.volume);
  return gas_.control == GasLoad::Control::Volume ? std::numeric_limits<double>::infinity() : 0;
}

double Potential::addBodyTerms(const std::vector<double>& z, std::vector<float>& gradient) {
  double value = 0, rounded = 0;
  const bool foundation = !body_.foundation.empty(), load = !body_.load.empty();
  for (int i = 0; i < body_.nodeCount(); ++i) {
    if (body_.fixed[i] != 0) {
      for (int k = 0; k < 3; ++k) gradient[4 * i + k] = 0;
      continue;
    }
    const double spring = inertia_ * body_.mass[i];
    for (int k = 0; k < 3; ++k) {
      const double away = z[4 * i + k] - scratch_.z_hat[4 * i + k], moved = z[4 * i + k] - body_.rest[i][k];
      double force = spring * away - body_.mass[i] * body_.gravity[k];
      value += 0.5 * spring * away * away - body_.mass[i] * body_.gravity[k] * moved;
      if (foundation) {
        force += body_.foundation[i] * moved;
        value += 0.5 * body_.foundation[i] * moved * moved;
      }
      if (load) {
        force -= body_.load[i][k];
        value -= body_.load[i][k] * moved;
      }
      rounded += std::abs(static_cast<double>(gradient[4 * i + k]) * scratch_.displacement[4 * i + k]);
      gradient[4 * i + k] += static_cast<float>(force);
    }
  }
  noise_ += kRounding * rounded;  // of the displacements, which are single precision
  return value;
}

}  // namespace vibe
