#include "vibe_hardware/emulator/emulator.hpp"

#include <algorithm>
#include <cmath>

namespace vibe {
namespace {

constexpr double kApproach = 2;  // time to reach a first position that is not 0 [s]

}  // namespace

EmulatedHaptic::Plants plantsOf(const EmulatorSetup& setup) {
  EmulatedHaptic::Plants plants;
  for (std::size_t i = 0; i < plants.size(); ++i) {
    plants[i].drive = setup.drive;
    plants[i].encoder_step = std::abs(static_cast<double>(setup.haptic.axes[i].radians_per_count));
  }
  plants[0].hand = handOnSlide(kHandMass, kHandDamping, kHandStiffness, setup.joints[Insertion].scale);
  plants[1].hand = kHandOnKnob;
  return plants;
}

Emulator::Emulator(const EmulatorSetup& setup, std::shared_ptr<const Hand> hand)
    : setup_(setup),
      hand_(std::move(hand)),
      haptic_(setup.haptic, plantsOf(setup), setup.serial),
      input_(setup.input, setup.serial) {
  const HandSample first = hand_->at(0);
  for (int joint = 0; joint < kScopeJointCount; ++joint)
    if (std::abs(axisPosition(setup_.joints[joint], first.joints[joint])) > 1e-6) approach_ = kApproach;
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

void Emulator::tick() {
  const HandSample sample = intention();
  DeviceMotion haptic, input;
  for (std::size_t axis = 0; axis < 2; ++axis) {
    haptic.intended[axis] = axisPosition(setup_.joints[axis], sample.joints[axis]);
    input.intended[axis] = axisPosition(setup_.joints[2 + axis], sample.joints[2 + axis]);
  }
  for (int button = 0; button < kButtonCount; ++button)
    if (sample.buttons[button] != 0) input.buttons = static_cast<std::uint16_t>(input.buttons | 1U << button);
  haptic_.tick(haptic);
  input_.tick(input);
  ++ticks_;
}

}  // namespace vibe
