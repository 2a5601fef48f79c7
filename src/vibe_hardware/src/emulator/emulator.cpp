#include "vibe_hardware/emulator/emulator.hpp"

#include <algorithm>
#include <cmath>

namespace vibe::hardware {

double TickSchedule::next() const {
  return origin_ + tick_ * static_cast<double>(ticks_);
}

int TickSchedule::due(double now) {
  delay_ = std::max(0.0, now - next());
  worst_delay_ = std::max(worst_delay_, delay_);
  if (delay_ > kDrop) {
    dropped_ += delay_;
    origin_ += delay_;
  }
  if (now < next()) return 0;
  const auto count = static_cast<int>(std::min((now - next()) / tick_, kMaxBurst - 1.0)) + 1;
  ticks_ += count;
  return count;
}

void SuturingDeviceFingers::decide(const Positions& intended, double report_period) {
  for (std::size_t j = 0; j < drives_.size(); ++j) {
    const ButtonDrive& drive = drives_[j];
    const double step = drive.speed * report_period;
    const double missing = std::clamp(intended[j], drive.lower, drive.upper) - positions_[j];
    direction_[j] = missing > 0.5 * step ? 1 : missing < -0.5 * step ? -1 : 0;
    positions_[j] = std::clamp(positions_[j] + direction_[j] * step, drive.lower, drive.upper);
  }
}

bool SuturingDeviceFingers::isPressed(const DeviceButton& button) const {
  for (std::size_t j = 0; j < drives_.size(); ++j)
    for (const int direction : {1, -1}) {
      const DeviceButton& other = direction == 1 ? drives_[j].forward : drives_[j].backward;
      if (direction_[j] == direction && other.device == button.device && other.bit == button.bit) return true;
    }
  return false;
}

namespace {

constexpr double kApproach = 2;  // time to reach a first position that is not 0 [s]

}  // namespace

EmulatedHaptic::Plants plantsOf(const EmulatorSetup& setup) {
  EmulatedHaptic::Plants plants;
  for (std::size_t i = 0; i < plants.size(); ++i) {
    plants[i].drive = setup.drive;
    plants[i].encoder_step = std::abs(static_cast<double>(setup.haptic.axes[i].radians_per_count));
    const int joint = setup.calibration.jointOf(DeviceKind::Haptic, static_cast<int>(i));
    plants[i].hand = kHandOnKnob;
    if (joint == Insertion)
      plants[i].hand =
          handOnSlide(kHandMass, kHandDamping, kHandStiffness, setup.calibration.joints[Insertion].scale.scale);
  }
  return plants;
}

Emulator::Emulator(const EmulatorSetup& setup, std::shared_ptr<const Hand> hand)
    : setup_(setup),
      hand_(std::move(hand)),
      haptic_(setup.haptic, plantsOf(setup), setup.serial),
      input_(setup.input, setup.serial) {
  if (setup.calibration.suturing_device) fingers_.emplace(*setup.calibration.suturing_device);
  const HandSample first = hand_->at(0);
  for (std::size_t joint = 0; joint < kScopeJointCount; ++joint)
    if (std::abs(axisPosition(setup_.calibration.joints[joint].scale, first.joints[joint])) > 1e-6)
      approach_ = kApproach;
}

EmulatedDevice& Emulator::device(DeviceKind kind) {
  if (kind == DeviceKind::Haptic) return haptic_;
  return input_;
}

HandSample Emulator::intention() const {
  const double time = handTime() + kTick;  // at the end of the tick
  HandSample sample = hand_->at(std::max(time, 0.0));
  if (time >= 0) return sample;
  const double s = 1 + time / approach_;
  for (double& joint : sample.joints) joint *= s * s * s * (10 + s * (6 * s - 15));  // minimum jerk
  sample.buttons = {};
  return sample;
}

DeviceMotion Emulator::motionOf(DeviceKind device, const HandSample& sample) const {
  DeviceMotion motion;
  for (std::size_t axis = 0; axis < motion.intended.size(); ++axis) {
    const int joint = setup_.calibration.jointOf(device, static_cast<int>(axis));
    if (joint < 0) continue;
    const auto j = static_cast<std::size_t>(joint);
    motion.intended[axis] = axisPosition(setup_.calibration.joints[j].scale, sample.joints[j]);
  }
  for (int bit = 0; bit < kDeviceButtons; ++bit) {
    bool pressed = fingers_ && fingers_->isPressed({device, bit});
    for (std::size_t b = 0; b < setup_.calibration.buttons.size(); ++b) {
      const std::optional<DeviceButton>& button = setup_.calibration.buttons[b];
      pressed |= button && button->device == device && button->bit == bit && sample.buttons[b] != 0;
    }
    if (pressed) motion.buttons = static_cast<std::uint16_t>(motion.buttons | 1U << bit);
  }
  return motion;
}

void Emulator::tick() {
  const HandSample sample = intention();
  const auto report_ticks = static_cast<std::int64_t>(setup_.input.report_ticks);
  if (fingers_ && ticks_ % report_ticks == 0) {
    SuturingDeviceFingers::Positions intended;
    std::copy(sample.joints.begin() + kScopeJointCount, sample.joints.end(), intended.begin());
    fingers_->decide(intended, kTick * static_cast<double>(report_ticks));
  }
  haptic_.tick(motionOf(DeviceKind::Haptic, sample));
  input_.tick(motionOf(DeviceKind::Input, sample));
  ++ticks_;
}

}  // namespace vibe::hardware
