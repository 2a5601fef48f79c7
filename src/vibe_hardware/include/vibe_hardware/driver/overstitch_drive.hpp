#pragma once
#include <array>

#include "vibe_hardware/driver/calibration.hpp"
#include "vibe_hardware/driver/scope_buttons.hpp"

namespace vibe::hardware {

/// Moves helix_advance, helix_rotation and needle_driver while buttons are held, for setups in which no camera tracks
/// the instruments.
class OverstitchDrive {
 public:
  using Positions = std::array<double, kOverstitchJointCount>;

  explicit OverstitchDrive(const std::array<ButtonDrive, kOverstitchJointCount>& drives) : drives_(drives) {}

  /// @param elapsed  since the last call; longer gaps than 0.1 s count as that [s]
  void advance(const ScopeButtons& buttons, double elapsed);

  /// Continues from measured positions, clamped to the limits: a camera has tracked the instruments up to now.
  void setPositions(const Positions& positions);

  const Positions& positions() const { return positions_; }  ///< [m], [rad], [m]

 private:
  std::array<ButtonDrive, kOverstitchJointCount> drives_;
  Positions positions_{};
};

}  // namespace vibe::hardware
