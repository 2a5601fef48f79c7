#pragma once
#include <algorithm>

#include "vibe_firmware/core/axis.hpp"

namespace vibe_firmware {

/// Energy that an axis gives to the hand: what the motor gives, less what the friction of the hardware takes. The motor
/// gives F dx per period; viscous and dry friction take at least b dx^2/T + f_c |dx|, whatever the motion in between.
class PortEnergy {
 public:
  explicit PortEnergy(const AxisConfig& config) : config_(config) {}

  /// One period with this torque [N m] and motion [rad].
  void add(double torque, double motion) {
    const double distance = motion < 0 ? -motion : motion;
    energy_ += torque * motion - config_.viscous_friction * motion * motion / config_.sample_period -
               config_.coulomb_friction * distance;
    lowest_ = std::min(lowest_, energy_);
    from_start_ = std::max(from_start_, energy_);
    from_lowest_ = std::max(from_lowest_, energy_ - lowest_);
  }

  double fromStart() const { return from_start_; }    ///< largest since the start [J]
  double fromLowest() const { return from_lowest_; }  ///< largest since any earlier moment [J]
  double final() const { return energy_; }

 private:
  AxisConfig config_;
  double energy_ = 0;
  double lowest_ = 0;
  double from_start_ = 0;
  double from_lowest_ = 0;
};

}  // namespace vibe_firmware
