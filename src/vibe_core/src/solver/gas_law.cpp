#include "solver/gas_law.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "common/elementary.hpp"

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

}  // namespace vibe
