#pragma once
#include <array>
#include <cstdint>

#include "vibe_hardware/driver/calibration.hpp"

namespace vibe::hardware {

/// The fingers of an emulated hand on the buttons that move the suturing device (Calibration::overstitch). They press
/// so that the joints follow intended positions, in steps of what the host adds up per report, and no faster than it
/// does.
class OverstitchFingers {
 public:
  using Positions = std::array<double, kOverstitchJointCount>;

  explicit OverstitchFingers(const std::array<ButtonDrive, kOverstitchJointCount>& drives) : drives_(drives) {}

  /// To be called once per report. @param intended  [m], [rad], [m]
  void decide(const Positions& intended, double report_period);

  bool isPressed(const DeviceButton& button) const;
  const Positions& positions() const { return positions_; }  ///< that the host should have after the next report

 private:
  std::array<ButtonDrive, kOverstitchJointCount> drives_;
  Positions positions_{};
  std::array<int, kOverstitchJointCount> direction_{};  // 1: forward, -1: backward
};

}  // namespace vibe::hardware
