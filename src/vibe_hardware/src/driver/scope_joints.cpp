#include "vibe_hardware/driver/scope_joints.hpp"

#include <algorithm>

namespace vibe::hardware {

namespace {

bool isPressed(const DeviceSample& sample, int bit) {
  return (sample.buttons >> bit & 1) != 0;
}

}  // namespace

ScopeJoints::ScopeJoints(const Calibration& calibration)
    : calibration_(calibration), leader_(calibration.joints[Insertion].device) {
  for (std::size_t j = 0; j < scales_.size(); ++j) scales_[j] = calibration.joints[j].scale;
}

bool ScopeJoints::take(DeviceKind device, const DeviceSample& sample) {
  for (std::size_t j = 0; j < positions_.size(); ++j) {
    if (calibration_.joints[j].device == device) takeJoint(j, sample);
  }
  known_[static_cast<std::size_t>(device)] = true;
  const bool homes = takeHoming(device, sample);
  homed_ = std::all_of(joint_homed_.begin(), joint_homed_.end(), [](bool homed) { return homed; });
  return homes;
}

void ScopeJoints::takeJoint(std::size_t joint, const DeviceSample& sample) {
  const JointCalibration& calibration = calibration_.joints[joint];
  const double axis = sample.position[static_cast<std::size_t>(calibration.axis)];
  JointScale& scale = scales_[joint];
  if (sample.restarted && seen_[joint]) {
    scale.offset = positions_[joint] - scale.scale * axis;
    joint_homed_[joint] = false;
  }
  seen_[joint] = true;
  axes_[joint] = axis;
  positions_[joint] = std::clamp(jointPosition(scale, axis), calibration.lower, calibration.upper);
  efforts_[joint] = jointEffort(scale, sample.torque[static_cast<std::size_t>(calibration.axis)]);
}

bool ScopeJoints::takeHoming(DeviceKind device, const DeviceSample& sample) {
  if (!calibration_.homing || calibration_.homing->device != device) return false;
  const bool was_pressed = homing_pressed_;
  homing_pressed_ = isPressed(sample, calibration_.homing->bit);
  if (!homing_pressed_ || was_pressed) return false;
  for (std::size_t j = 0; j < scales_.size(); ++j) {
    const JointCalibration& calibration = calibration_.joints[j];
    if (!calibration.home || !known_[static_cast<std::size_t>(calibration.device)]) continue;
    scales_[j].offset = *calibration.home - scales_[j].scale * axes_[j];
    positions_[j] = *calibration.home;
    joint_homed_[j] = true;
  }
  return true;
}

void ScopeJoints::lose(DeviceKind device) {
  known_[static_cast<std::size_t>(device)] = false;
  if (calibration_.homing && calibration_.homing->device == device) homing_pressed_ = false;
}

bool ScopeJoints::isKnown() const {
  for (const DeviceKind device : {DeviceKind::Haptic, DeviceKind::Input}) {
    if (calibration_.uses(device) && !known_[static_cast<std::size_t>(device)]) return false;
  }
  return true;
}

bool ScopeButtons::take(DeviceKind device, std::uint16_t bits) {
  bits_[static_cast<std::size_t>(device)] = bits;
  const auto before = pressed_;
  for (std::size_t b = 0; b < pressed_.size(); ++b) {
    const auto& button = calibration_.buttons[b];
    pressed_[b] = button && isPressed(*button) ? 1 : 0;
  }
  return pressed_ != before;
}

namespace {

constexpr double kLongestStep = 0.1;  // a gap in the samples is not a motion [s]

}  // namespace

void SuturingDeviceDrive::advance(const ScopeButtons& buttons, double elapsed) {
  const double time = std::clamp(elapsed, 0.0, kLongestStep);
  Positions moved = positions_;
  for (std::size_t j = 0; j < drives_.size(); ++j) {
    const int direction = buttons.isPressed(drives_[j].forward) - buttons.isPressed(drives_[j].backward);
    moved[j] += direction * drives_[j].speed * time;
  }
  setPositions(moved);
}

void SuturingDeviceDrive::setPositions(const Positions& positions) {
  for (std::size_t j = 0; j < drives_.size(); ++j) {
    positions_[j] = std::clamp(positions[j], drives_[j].lower, drives_[j].upper);
  }
}

}  // namespace vibe::hardware
