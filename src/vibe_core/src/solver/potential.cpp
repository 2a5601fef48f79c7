#include "solver/potential.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "tissue/shell.hpp"
#include "vibe_core/solver/energy_term.hpp"

namespace vibe {

namespace {
constexpr double kRounding = 6e-8;  // half a unit in the last place of single precision (2^-24) [1]
}

double Potential::evaluate(const std::vector<double>& z, std::vector<float>& gradient) {
  const int n = body_.nodeCount();
  float* u = scratch_.displacement.data();
  const double* const rest = scratch_.rest.data();
  for (int i = 0; i < 4 * n; ++i) u[i] = static_cast<float>(z[i] - rest[i]);
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
    for (int i = 0; i < n; ++i)
      if (body_.fixed[i] != 0)
        for (int k = 0; k < 3; ++k) scratch_.volume_gradient[4 * i + k] = 0;
  } else {
    for (int p = 0; p < pieces; ++p) value += body_.elements->evaluate(p, u, gradient.data());
    elastic_ = value;
    noise_ = 1e-6 * std::abs(value);
  }
  if (extra_ != nullptr) value += extra_->evaluate(z.data(), gradient.data());
  return value + addSprings(z, gradient) + addBodyTerms(z, gradient);
}

double Potential::addSprings(const std::vector<double>& z, std::vector<float>& gradient) const {
  double energy = 0;
  scratch_.rows.forEachSpring([&](int r, const LinearForm& form, double compliance) {
    double longer = -scratch_.target[r];
    for (std::size_t i = 0; i < form.node.size(); ++i)
      for (int k = 0; k < 3; ++k) longer += form.coefficient[i][k] * z[4 * static_cast<std::size_t>(form.node[i]) + k];
    const double force = longer / compliance;
    energy += 0.5 * force * longer;
    form.addForce(force, gradient);
  });
  return energy;
}

double Potential::gasEnergy() {
  scratch_.pressure = gas_law_.pressure(scratch_.volume);
  noise_ += 1e-7 * std::abs(scratch_.pressure * scratch_.volume);
  return gas_law_.energy(scratch_.volume);
}

void Potential::moveVolume(double change) {
  scratch_.volume += change;
  scratch_.pressure = gas_law_.pressure(scratch_.volume);
}

// Four lanes per node, the last of them zero, so that the compiler can use vectors of them.
double Potential::addBodyTerms(const std::vector<double>& z, std::vector<float>& gradient) {
  const double* const hat = scratch_.z_hat.data();
  const double pull[4] = {body_.gravity[0], body_.gravity[1], body_.gravity[2], 0};
  double twice[4] = {0, 0, 0, 0}, work[4] = {0, 0, 0, 0}, rounded[4] = {0, 0, 0, 0};
  for (int i = 0; i < body_.nodeCount(); ++i) {
    float* const g = &gradient[4 * i];
    if (body_.fixed[i] != 0) {
      for (int k = 0; k < 4; ++k) g[k] = 0;
      continue;
    }
    const double mass = body_.mass[i], spring = inertia_ * mass;
    const float* const u = &scratch_.displacement[4 * i];
    for (int k = 0; k < 4; ++k) {
      const double away = z[4 * i + k] - hat[4 * i + k], force = spring * away, weight = mass * pull[k];
      twice[k] += force * away;
      work[k] += weight * u[k];
      rounded[k] += static_cast<double>(std::abs(g[k] * u[k]));
      g[k] += static_cast<float>(force - weight);
    }
  }
  noise_ += kRounding * (rounded[0] + rounded[1] + rounded[2]);  // of the displacements, which are single precision
  return 0.5 * (twice[0] + twice[1] + twice[2]) - (work[0] + work[1] + work[2]) + addRareTerms(z, gradient);
}

// Springs to the rest position and dead loads, which few bodies have.
double Potential::addRareTerms(const std::vector<double>& z, std::vector<float>& gradient) {
  const bool foundation = !body_.foundation.empty(), load = !body_.load.empty();
  if (!foundation && !load) return 0;
  double value = 0;
  for (int i = 0; i < body_.nodeCount(); ++i) {
    if (body_.fixed[i] != 0) continue;
    for (int k = 0; k < 3; ++k) {
      const double moved = z[4 * i + k] - body_.rest[i][k];
      const double spring = foundation ? body_.foundation[i] : 0, dead = load ? body_.load[i][k] : 0;
      value += (0.5 * spring * moved - dead) * moved;
      gradient[4 * i + k] += static_cast<float>(spring * moved - dead);
    }
  }
  return value;
}

}  // namespace vibe
