#include "vibe_hardware/emulator/overstitch_fingers.hpp"

#include <algorithm>

namespace vibe::hardware {

void OverstitchFingers::decide(const Positions& intended, double report_period) {
  for (std::size_t j = 0; j < drives_.size(); ++j) {
    const ButtonDrive& drive = drives_[j];
    const double step = drive.speed * report_period;
    const double missing = std::clamp(intended[j], drive.lower, drive.upper) - positions_[j];
    direction_[j] = missing > 0.5 * step ? 1 : missing < -0.5 * step ? -1 : 0;
    positions_[j] = std::clamp(positions_[j] + direction_[j] * step, drive.lower, drive.upper);
  }
}

bool OverstitchFingers::isPressed(const DeviceButton& button) const {
  for (std::size_t j = 0; j < drives_.size(); ++j)
    for (const int direction : {1, -1}) {
      const DeviceButton& other = direction == 1 ? drives_[j].forward : drives_[j].backward;
      if (direction_[j] == direction && other.device == button.device && other.bit == button.bit) return true;
    }
  return false;
}

}  // namespace vibe::hardware
