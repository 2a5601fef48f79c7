#include "solver/potential.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "arithmetic/elementary.hpp"
#include "vibe_core/solver/energy_term.hpp"
#include "vibe_core/tissue/shell.hpp"

#include "vibe_core/solver/step_policy.hpp"

namespace vibe {

GasLaw::GasLaw(const GasLoad& load, double part)
    : load_(load),
      amount_min_(load.amount + part * (load.amount_min - load.amount)),
      amount_max_(load.amount + part * (load.amount_max - load.amount)),
      volume_min_(amount_min_ / (load.set_pressure + load.ambient)),
      volume_max_(amount_max_ / (load.set_pressure + load.ambient)) {}

GasLaw::Piece GasLaw::pieceAt(double volume) const {
  if (load_.control != GasLoad::Control::Regulated) return Piece::Kept;
  return volume < volume_min_ ? Piece::Least : volume > volume_max_ ? Piece::Most : Piece::Kept;
}

GasLaw::Line GasLaw::lineOf(Piece piece, double volume) const {
  const double v = std::max(volume, kSmallestVolume);
  const auto closed = [&](double amount) { return Line{amount / v - load_.ambient, amount / (v * v)}; };
  switch (load_.control) {
    case GasLoad::Control::Amount:
      return closed(load_.amount);
    case GasLoad::Control::Regulated:
      if (piece == Piece::Kept) return {load_.set_pressure, 0};
      return closed(piece == Piece::Least ? amount_min_ : amount_max_);
    case GasLoad::Control::Volume:
      return {load_.pressure, std::numeric_limits<double>::infinity()};
    default:
      return {load_.pressure, 0};
  }
}

double GasLaw::pressure(double volume) const {
  return lineOf(pieceAt(volume), volume).pressure;
}

double GasLaw::stiffness(double volume) const {
  return lineOf(pieceAt(volume), volume).stiffness;
}

double GasLaw::energy(double volume) const {
  const double v = std::max(volume, kSmallestVolume);
  switch (load_.control) {
    case GasLoad::Control::Amount:
      return closedEnergy(load_.amount, load_.volume, v);
    case GasLoad::Control::Regulated: {
      const double kept = std::clamp(v, volume_min_, volume_max_);
      const double outside = v < volume_min_   ? closedEnergy(amount_min_, volume_min_, v)
                             : v > volume_max_ ? closedEnergy(amount_max_, volume_max_, v)
                                               : 0;
      return outside - load_.set_pressure * (kept - load_.volume);
    }
    default:
      return -load_.pressure * (volume - load_.volume);
  }
}

// Isothermal, from one volume to another.
double GasLaw::closedEnergy(double amount, double from, double volume) const {
  return load_.ambient * (volume - from) - amount * math::log(volume / std::max(from, kSmallestVolume));
}

namespace {
constexpr double kRounding = 6e-8;  // half a unit in the last place of single precision (2^-24)
}

double Potential::evaluate(const std::vector<double>& z, std::vector<float>& gradient) {
  startSums(z, gradient);
  const bool has_gas = gas_.control != GasLoad::Control::None;
  double volume = 0;
  double value = addElements(gradient, volume);
  elastic_ = value;
  noise_ = stepPolicy().elastic_noise * (std::abs(value) + std::abs(at_.last.stress_work));
  at_.last.elastic_value = value += addRareTerms(z, gradient);
  at_.last.elastic_gradient = gradient;
  value += at_.last.stress_work;
  if (has_gas) {
    at_.last.volume = volume;
    value += gasEnergy();
  }
  if (extra_ != nullptr) value += addExtra(z, gradient);
  return value + addSprings(z, gradient) + addBodyTerms(z, gradient);
}

double Potential::addElements(std::vector<float>& gradient, double& volume) {
  const bool has_gas = gas_.control != GasLoad::Control::None;
  const float* const u = at_.last.displacement.data();
  float* const volume_gradient = has_gas ? at_.last.volume_gradient.data() : nullptr;
  const float* const stress = stress_ != nullptr ? stress_->data() : nullptr;
  SharedEvaluation& shared = scratch_.shared;
  at_.last.stress_work = 0;
  if (!shared.shares.empty()) {
    const double all = shared.evaluate(*body_.shell, *scratch_.pool, u, gradient.data(), volume_gradient, stress);
    for (const double part : shared.volume) volume += part;
    for (const double part : shared.stress_work) at_.last.stress_work += part;
    return all;
  }
  double value = 0;
  for (int p = 0; p < body_.elements->pieceCount(); ++p) {
    double part = 0;
    ConstantStress beside{stress};
    value += has_gas || stress != nullptr ? body_.shell->evaluate(p, u, gradient.data(), volume_gradient, part, &beside)
                                          : body_.elements->evaluate(p, u, gradient.data());
    volume += part;
    at_.last.stress_work += beside.work;
  }
  return value;
}

// The displacements, and zeros to add to.
void Potential::startSums(const std::vector<double>& z, std::vector<float>& gradient) {
  const std::size_t size = z.size();
  const double *const at = z.data(), *const rest = scratch_.rest.data();
  float *const u = at_.last.displacement.data(), *const g = gradient.data(), *const v = at_.last.volume_gradient.data();
  for (std::size_t i = 0; i < size; ++i) {
    u[i] = static_cast<float>(at[i] - rest[i]);
    g[i] = 0;
    v[i] = 0;
  }
}

double Potential::addExtra(const std::vector<double>& z, std::vector<float>& gradient) const {
  std::vector<float>& extra = at_.last.extra_gradient;
  std::fill(extra.begin(), extra.end(), 0.0F);
  const double value = extra_->evaluate(z.data(), extra.data());
  for (std::size_t i = 0; i < gradient.size(); ++i) gradient[i] += extra[i];
  return value;
}

double Potential::addSprings(const std::vector<double>& z, std::vector<float>& gradient) const {
  double energy = 0;
  system_.rows.forEachSpring([&](int r, const LinearForm& form, double compliance) {
    double longer = -system_.target[r];
    for (std::size_t i = 0; i < form.node.size(); ++i)
      for (int k = 0; k < 3; ++k) longer += form.coefficient[i][k] * z[4 * static_cast<std::size_t>(form.node[i]) + k];
    const double force = longer / compliance;
    energy += 0.5 * force * longer;
    form.addForce(force, gradient);
  });
  return energy;
}

double Potential::gasEnergy() {
  Evaluation& here = at_.last;
  here.pressure = gas_law_.pressure(here.volume);
  noise_ += stepPolicy().gas_noise * std::abs(here.pressure * here.volume);
  return gas_law_.energy(here.volume);
}

void Potential::moveVolume(double change) {
  at_.last.volume += change;
  at_.last.pressure = gas_law_.pressure(at_.last.volume);
}

// Gas pressure, inertia and weight. Four lanes per node, the last of them zero, so that the compiler can
// use vectors of them.
double Potential::addBodyTerms(const std::vector<double>& z, std::vector<float>& gradient) {
  const double *const hat = at_.z_hat.data(), *const rest = scratch_.rest.data();
  float* const area = at_.last.volume_gradient.data();
  const float pressure = gas_.control != GasLoad::Control::None ? static_cast<float>(at_.last.pressure) : 0.0F;
  const double pull[4] = {body_.gravity[0], body_.gravity[1], body_.gravity[2], 0};
  double twice[4] = {0, 0, 0, 0}, work[4] = {0, 0, 0, 0}, rounded[4] = {0, 0, 0, 0};
  for (int i = 0; i < body_.nodeCount(); ++i) {
    float *const g = &gradient[4 * i], *const push = &area[4 * i];
    if (body_.fixed[i] != 0) {
      // a fixed node takes no force, and the volume does not depend on it
      for (int k = 0; k < 4; ++k) g[k] = 0, push[k] = 0;
      continue;
    }
    const double mass = body_.mass[i], spring = inertia_ * mass;
    const float* const u = &at_.last.displacement[4 * i];
    for (int k = 0; k < 4; ++k) {
      const double away = z[4 * i + k] - hat[4 * i + k], moved = z[4 * i + k] - rest[4 * i + k];
      const double force = spring * away, weight = mass * pull[k];
      const float before = g[k] - pressure * push[k];
      twice[k] += force * away;
      work[k] += weight * moved;
      rounded[k] += static_cast<double>(std::abs(before * u[k]));
      g[k] = before + static_cast<float>(force - weight);
    }
  }
  noise_ += kRounding * (rounded[0] + rounded[1] + rounded[2]);  // of the displacements, which are single precision
  return 0.5 * (twice[0] + twice[1] + twice[2]) - (work[0] + work[1] + work[2]);
}

// Springs to the rest position and dead loads, which few bodies have.
double Potential::addRareTerms(const std::vector<double>& z, std::vector<float>& gradient) const {
  const bool foundation = !body_.foundation.empty(), load = !body_.load.empty();
  if (!foundation && !load) return 0;
  double value = 0;
  for (int i = 0; i < body_.nodeCount(); ++i) {
    if (body_.fixed[i] != 0) continue;
    const double spring = foundation ? body_.foundation[i] : 0;
    for (int k = 0; k < 3; ++k) {
      const double moved = z[4 * i + k] - body_.rest[i][k], pull = load ? body_.load[i][k] : 0;
      value += (0.5 * spring * moved - pull) * moved;
      gradient[4 * i + k] += static_cast<float>(spring * moved - pull);
    }
  }
  return value;
}

}  // namespace vibe
