#include "dynamics/loss_limits.hpp"

#include <algorithm>
#include <limits>

#include "arithmetic/elementary.hpp"
#include "vibe_core/solver/step_policy.hpp"
#include "vibe_core/tissue/shell.hpp"

namespace vibe {

namespace {

// Stretches at which the borne pressure is tabulated: to three times the size, where no organ comes.
constexpr double kSpacing = 0.02;
constexpr int kStretches = 100;

}  // namespace

LossLimits::LossLimits(const ShellElements& shell, const std::vector<Eigen::Vector3d>& rest)
    : limit_stretch_(std::numeric_limits<double>::infinity()), limit_pressure_(limit_stretch_) {
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& p : rest) centre += p / static_cast<double>(rest.size());
  std::vector<double> none(3 * rest.size()), volume_gradient(3 * rest.size());
  rest_volume_ = shell.volume(none.data(), volume_gradient.data());
  std::vector<float> u(4 * rest.size()), gradient(4 * rest.size());
  const auto energyAt = [&](double stretch) {
    for (std::size_t i = 0; i < rest.size(); ++i)
      for (int k = 0; k < 3; ++k) u[4 * i + k] = static_cast<float>((stretch - 1) * (rest[i] - centre)[k]);
    double energy = 0;
    for (int piece = 0; piece < shell.pieceCount(); ++piece) energy += shell.evaluate(piece, u.data(), gradient.data());
    return energy;
  };
  // all other loads store far less than a wall that is twice as large
  unheld_energy_ = 0.1 * energyAt(2);
  double before = energyAt(1);
  for (int k = 0; k < kStretches && rest_volume_ > 0; ++k) {
    const double stretch = 1 + (k + 0.5) * kSpacing, energy = energyAt(1 + (k + 1) * kSpacing);
    pressure_.push_back((energy - before) / kSpacing / (3 * stretch * stretch * rest_volume_));
    before = energy;
  }
  // the first maximum: beyond it more gas means less pressure
  for (std::size_t k = 1; k + 1 < pressure_.size(); ++k)
    if (pressure_[k] > pressure_[k - 1] && pressure_[k] >= pressure_[k + 1]) {
      limit_stretch_ = 1 + (static_cast<double>(k) + 0.5) * kSpacing;
      limit_pressure_ = pressure_[k];
      break;
    }
}

bool LossLimits::bursts(double volume, double pressure, bool filling) const {
  if (!(rest_volume_ > 0) || !(volume > 0)) return false;
  const double stretch = math::cbrt(volume / rest_volume_);
  if (!(stretch > limit_stretch_)) return false;
  const auto at = static_cast<std::size_t>((stretch - 1) / kSpacing);
  const double borne = pressure_[std::min(at, pressure_.size() - 1)];
  return pressure > borne || (filling && stretch > stepPolicy().burst_stretch * limit_stretch_);
}

}  // namespace vibe
