#pragma once

#include <vector>

#include <Eigen/Core>

namespace vibe {

class ShellElements;

/// What tells a state that has no way back from one that its loads hold. Judged by the law of the wall itself.
///
/// A wall that swells uniformly by a stretch s bears the pressure p(s) = dW/ds / (3 s^2 V), W its elastic energy and V
/// its volume at rest. Laws that stiffen little have a greatest p, the limit pressure (a neo-Hookean sphere at
/// s = 1.38; Beatty 1987, doi 10.1115/1.3149545, section 6). Beyond it an insufflator finds no equilibrium: the wall
/// bursts. Walls that stiffen enough have no such limit and are left alone at any stretch.
class LossLimits {
 public:
  /// @param rest  positions at rest [m]
  LossLimits(const ShellElements& shell, const std::vector<Eigen::Vector3d>& rest);

  /// Elastic energy that only gas can store in a wall: a tenth of what makes the whole organ twice as large [J].
  double unheldEnergy() const { return unheld_energy_; }
  /// Whether the wall bursts.
  /// @param volume    of the lumen [m^3]
  /// @param pressure  gauge, of the gas [Pa]
  /// @param filling   an insufflator works
  bool bursts(double volume, double pressure, bool filling) const;
  /// Greatest pressure that the swelling wall bears; infinite without one [Pa].
  double limitPressure() const { return limit_pressure_; }
  /// The stretch there; infinite without one.
  double limitStretch() const { return limit_stretch_; }

 private:
  double rest_volume_ = 0;
  double unheld_energy_ = 0;
  double limit_stretch_, limit_pressure_;
  std::vector<double> pressure_;  // borne at the middle of each interval of the table
};

}  // namespace vibe
