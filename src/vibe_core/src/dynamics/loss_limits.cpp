#include "dynamics/loss_limits.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "common/elementary.hpp"
#include "vibe_core/tissue/shell.hpp"

namespace vibe {

namespace {

// Stretches at which the borne pressure is tabulated. Design choice: to three times the size, where no organ comes.
constexpr double kSpacing = 0.02;
constexpr int kStretches = 100;
// Stretch over that of the limit pressure from which a wall counts as bursting while an insufflator works, whatever the
// pressure: the flow may be too small to keep it. Design choice: a shape other than a sphere reaches its own limit
// before [1].
constexpr double kFarBeyond = 1.25;

}  // namespace

LossLimits::LossLimits(const ShellElements& shell, const std::vector<Eigen::Vector3d>& rest)
    : limit_stretch_(std::numeric_limits<double>::infinity()), limit_pressure_(limit_stretch_) {
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& p : rest) centre += p / static_cast<double>(rest.size());
  std::vector<double> u(3 * rest.size()), gradient(3 * rest.size());
  const auto energyAt = [&](double stretch) {
    for (std::size_t i = 0; i < rest.size(); ++i)
      for (int k = 0; k < 3; ++k) u[3 * i + k] = (stretch - 1) * (rest[i] - centre)[k];
    std::fill(gradient.begin(), gradient.end(), 0.0);
    return shell.evaluate(u.data(), gradient.data());
  };
  std::fill(u.begin(), u.end(), 0.0);
  rest_volume_ = shell.volume(u.data(), gradient.data());
  unheld_energy_ = 0.1 * energyAt(2);
  double before = energyAt(1);
  for (int k = 0; k < kStretches && rest_volume_ > 0; ++k) {
    const double stretch = 1 + (k + 0.5) * kSpacing, energy = energyAt(1 + (k + 1) * kSpacing);
    pressure_.push_back((energy - before) / kSpacing / (3 * stretch * stretch * rest_volume_));
    before = energy;
  }
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
  return pressure > borne || (filling && stretch > kFarBeyond * limit_stretch_);
}

}  // namespace vibe
