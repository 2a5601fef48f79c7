#include "emulator/loop_host.hpp"

#include <algorithm>
#include <stdexcept>

namespace vibe::hardware {

LoopHost::LoopHost(EmulatorBus& bus, const Calibration& calibration, std::function<double()> clock)
    : joints_(calibration),
      buttons_(calibration),
      haptic_(bus, calibration.devices[0], clock, callbacksOf(DeviceKind::Haptic)),
      input_driver_(bus, DeviceKind::Input, calibration.devices[1], clock, callbacksOf(DeviceKind::Input)) {
  if (calibration.suturing_device) suturing_device_.emplace(*calibration.suturing_device);
}

DeviceDriver::Callbacks LoopHost::callbacksOf(DeviceKind kind) {
  DeviceDriver::Callbacks callbacks;
  callbacks.sample = [this, kind](const DeviceSample& sample) { take(kind, sample); };
  callbacks.connected = [](const DeviceConnection&) {};
  callbacks.lost = [](double) {};
  callbacks.message = [](Severity severity, const std::string& sentence) {
    if (severity == Severity::Warning) throw std::runtime_error(sentence);  // nothing goes wrong here
  };
  return callbacks;
}

void LoopHost::poll() {
  input_driver_.poll(0);
  haptic_.poll(0);
}

void LoopHost::take(DeviceKind kind, const DeviceSample& sample) {
  joints_.take(kind, sample);
  buttons_.take(kind, sample.buttons);
  if (kind == DeviceKind::Input && suturing_device_) {
    suturing_device_->advance(buttons_, sample.time - last_time_);
    last_time_ = sample.time;
    std::copy(suturing_device_->positions().begin(), suturing_device_->positions().end(),
              input_.joints.begin() + kScopeJointCount);
  }
  std::copy(joints_.positions().begin(), joints_.positions().end(), input_.joints.begin());
  input_.buttons = buttons_.pressed();
  if (joints_.isKnown() && joints_.leads(kind)) history_.push_back({sample.time, input_});
}

StepInput LoopHost::inputAt(double time) const {
  const auto after = std::upper_bound(history_.begin(), history_.end(), time,
                                      [](double t, const Stamped& stamped) { return t < stamped.time; });
  return after == history_.begin() ? StepInput() : (after - 1)->input;
}

void LoopHost::render(const std::optional<ToolImpedance>& impedance, Rendering rendering) {
  if (!impedance && touching_) haptic_.release();
  touching_ = impedance.has_value();
  if (!impedance) return;
  HapticDriver::Targets targets;
  for (std::size_t axis = 0; axis < targets.size(); ++axis) {
    const int joint = joints_.calibration().jointOf(DeviceKind::Haptic, static_cast<int>(axis));
    if (joint < 0) continue;
    const JointResponse& response = impedance->joints[static_cast<std::size_t>(joint)];
    JointSpring spring{response.position, response.effort, response.stiffness, response.damping, response.velocity};
    if (rendering == Rendering::Held) spring.stiffness = spring.damping = 0;
    targets[axis] = springOnAxis(joints_.scale(joint), spring);
  }
  haptic_.setTarget(targets);
}

}  // namespace vibe::hardware
