#include "solver/gas_law.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace vibe {

namespace {
// A smaller volume counts as this, so that pressure and energy stay finite in any state [m^3].
constexpr double kSmallestVolume = 1e-12;
}  // namespace

GasLaw::GasLaw(const GasLoad& load, double part)
    : load_(load),
      amount_min_(load.amount + part * (load.amount_min - load.amount)),
      amount_max_(load.amount + part * (load.amount_max - load.amount)),
      volume_min_(amount_min_ / (load.set_pressure + load.ambient)),
      volume_max_(amount_max_ / (load.set_pressure + load.ambient)) {}

double GasLaw::pressure(double volume) const {
  const double v = std::max(volume, kSmallestVolume);
  switch (load_.control) {
    case GasLoad::Control::Amount:
      return load_.amount / v - load_.ambient;
    case GasLoad::Control::Regulated:
      return v < volume_min_   ? amount_min_ / v - load_.ambient
             : v > volume_max_ ? amount_max_ / v - load_.ambient
                               : load_.set_pressure;
    default:
      return load_.pressure;
  }
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
  return load_.ambient * (volume - from) - amount * std::log(volume / std::max(from, kSmallestVolume));
}

double GasLaw::stiffness(double volume) const {
  const double v = std::max(volume, kSmallestVolume);
  switch (load_.control) {
    case GasLoad::Control::Amount:
      return load_.amount / (v * v);
    case GasLoad::Control::Regulated:
      return v < volume_min_ ? amount_min_ / (v * v) : v > volume_max_ ? amount_max_ / (v * v) : 0;
    case GasLoad::Control::Volume:
      return std::numeric_limits<double>::infinity();
    default:
      return 0;
  }
}

}  // namespace vibe
