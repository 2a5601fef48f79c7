#include "vibe_hardware/driver/haptic_link.hpp"

#include <algorithm>

namespace vibe::hardware {
namespace {

constexpr double kTimeRounding = 1e-6;  // of times [s]

vibe_firmware::AxisParameters scaled(vibe_firmware::AxisParameters spring, double gain) {
  const auto factor = static_cast<float>(gain);
  spring.stiffness *= factor;
  spring.damping *= factor;
  spring.torque *= factor;
  return spring;
}

}  // namespace

void HapticLink::setTarget(const Springs& springs, double now) {
  target_ = springs;
  target_time_ = now;
  touching_ = true;
  changed_ = true;
}

void HapticLink::release(double now) {
  if (!touching_) return;
  touching_ = false;
  release_time_ = now;
  changed_ = true;
}

void HapticLink::restart() {
  target_ = {};
  touching_ = changed_ = false;
  target_time_ = release_time_ = last_sent_ = kNever;
}

double HapticLink::gain(double now) const {
  return touching_ ? 1 : std::clamp(1 - (now - release_time_) / kFade, 0.0, 1.0);
}

std::optional<vibe_firmware::ParameterReport> HapticLink::next(double now) {
  if (touching_ && now - target_time_ > kTimeout) release(now);
  const double since = now - last_sent_ + kTimeRounding;
  const double present = gain(now);
  const bool fading = !touching_ && (present > 0 || changed_);
  const double period = changed_ || fading ? kMinPeriod : kHeartbeat;
  if (since < period) return std::nullopt;
  changed_ = present > 0 && !touching_;  // until the spring has gone
  last_sent_ = now;
  if (++report_.number == 0) report_.number = 1;
  for (std::size_t a = 0; a < target_.size(); ++a) report_.axes[a] = scaled(target_[a], present);
  return report_;
}

}  // namespace vibe::hardware
