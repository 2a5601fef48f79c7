#include "vibe_hardware/driver/overstitch_drive.hpp"

#include <algorithm>

namespace vibe::hardware {
namespace {

constexpr double kLongestStep = 0.1;  // a gap in the samples is not a motion [s]

}  // namespace

void OverstitchDrive::advance(const ScopeButtons& buttons, double elapsed) {
  const double time = std::clamp(elapsed, 0.0, kLongestStep);
  Positions moved = positions_;
  for (std::size_t j = 0; j < drives_.size(); ++j) {
    const int direction = buttons.isPressed(drives_[j].forward) - buttons.isPressed(drives_[j].backward);
    moved[j] += direction * drives_[j].speed * time;
  }
  setPositions(moved);
}

void OverstitchDrive::setPositions(const Positions& positions) {
  for (std::size_t j = 0; j < drives_.size(); ++j) {
    positions_[j] = std::clamp(positions[j], drives_[j].lower, drives_[j].upper);
  }
}

}  // namespace vibe::hardware
