#include "vibe_hardware/driver/haptic_driver.hpp"

#include <algorithm>
#include <cstring>

#include "vibe_core/program/error.hpp"
#include "vibe_hardware/driver/joint_scale.hpp"

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

namespace {

using vibe_firmware::AxisParameters;
using vibe_firmware::ParameterReport;

struct Member {
  const char* name;
  float AxisParameters::*value;
};
constexpr Member kMembers[] = {{"stiffness", &AxisParameters::stiffness},
                               {"damping", &AxisParameters::damping},
                               {"position", &AxisParameters::position},
                               {"torque", &AxisParameters::torque},
                               {"torque limit", &AxisParameters::torque_limit}};

}  // namespace

std::string firstDifference(const ParameterReport& sent, const ParameterReport& read) {
  if (sent.number != read.number) {
    return "the number of the set is " + std::to_string(read.number) + " instead of " + std::to_string(sent.number);
  }
  for (std::size_t a = 0; a < sent.axes.size(); ++a) {
    for (const Member& member : kMembers) {
      const float wanted = sent.axes[a].*member.value, found = read.axes[a].*member.value;
      if (std::memcmp(&wanted, &found, sizeof wanted) == 0) continue;
      return std::string(member.name) + " of axis " + std::to_string(a) + " is " + std::to_string(found) +
             " instead of " + std::to_string(wanted);
    }
  }
  return "";
}

HapticDriver::HapticDriver(HidBus& bus, DeviceSelection selection, std::function<double()> clock,
                           DeviceDriver::Callbacks callbacks)
    : user_(std::move(callbacks)), device_(bus, DeviceKind::Haptic, std::move(selection), std::move(clock), wrap()) {}

DeviceDriver::Callbacks HapticDriver::wrap() {
  DeviceDriver::Callbacks callbacks = user_;
  callbacks.sample = [this](const DeviceSample& sample) { onSample(sample); };
  callbacks.connected = [this](const DeviceConnection& connection) {
    user_.connected(connection);
    link_.restart();
    refused_before_ = connection.status().refused;
    confirmed_ = opened_ = device_.now();
    next_verify_ = 0;
    differed_ = false;
    refused_flag_ = ask_status_ = false;
  };
  callbacks.lost = [this](double now) {
    statistics_.in_force = false;
    link_.release(now);
    user_.lost(now);
  };
  return callbacks;
}

void HapticDriver::setTarget(const Targets& targets) {
  const std::lock_guard<std::mutex> lock(inbox_mutex_);
  if (device_.now() < ignored_until_) return;
  inbox_ = targets;
  inbox_release_ = false;
}

void HapticDriver::release(double pause) {
  const std::lock_guard<std::mutex> lock(inbox_mutex_);
  inbox_.reset();
  inbox_release_ = true;
  ignored_until_ = std::max(ignored_until_, device_.now() + pause);
}

void HapticDriver::poll(double wait) {
  device_.poll(wait);
  takeInbox();
  // A device that does not speak is not spoken to: its watchdog takes the torque away, and a request to it could block.
  if (device_.state() != LinkState::Running || device_.sinceReport() > DeviceDriver::kQuiet) return;
  try {
    sendDue();
    verify();
    checkRefusals();
  } catch (const DeviceGone& gone) {
    device_.drop(gone.what());
  } catch (const Error& error) {
    device_.messages().warn("parameters", "The haptic device does not take parameters. " + std::string(error.what()),
                            device_.now());
  }
}

void HapticDriver::takeInbox() {
  std::optional<Targets> targets;
  bool released = false;
  {
    const std::lock_guard<std::mutex> lock(inbox_mutex_);
    targets.swap(inbox_);
    std::swap(released, inbox_release_);
  }
  if (released) link_.release(device_.now());
  if (!targets || device_.connection() == nullptr) return;
  HapticLink::Springs springs;
  bool clamped = false;
  for (std::size_t a = 0; a < springs.size(); ++a) {
    const PassiveSpring spring = passiveSpring(device_.connection()->axes()[a], (*targets)[a]);
    springs[a] = spring.parameters;
    clamped |= spring.clamped;
  }
  statistics_.clamped += clamped ? 1 : 0;
  link_.setTarget(springs, device_.now());
}

void HapticDriver::sendDue() {
  const std::optional<ParameterReport> report = link_.next(device_.now());
  if (!report) return;
  device_.connection()->sendParameters(*report);
  ++statistics_.sent;
}

void HapticDriver::onSample(const DeviceSample& sample) {
  const auto behind = static_cast<std::uint16_t>(link_.last().number - sample.parameter_number);
  const double now = device_.now();
  // reports were packed before the last sets were sent
  if (behind <= kTakeOver / HapticLink::kMinPeriod && link_.last().number != 0) confirmed_ = now;
  statistics_.in_force = now - confirmed_ <= kTakeOver && (sample.flags & vibe_firmware::kHostSilent) == 0;
  // the first report after opening the device may be older than the first parameters
  if (now - opened_ > kTakeOver && (sample.flags & vibe_firmware::kHostSilent) != 0) ++statistics_.starved;
  const bool refused = (sample.flags & vibe_firmware::kRefused) != 0;
  ask_status_ |= refused && !refused_flag_;
  refused_flag_ = refused;
  user_.sample(sample);
}

void HapticDriver::verify() {
  const double now = device_.now();
  if (now < next_verify_ || link_.last().number == 0) return;
  next_verify_ = now + kVerifyPeriod;
  const std::string difference = firstDifference(link_.last(), device_.connection()->readParameters());
  if (difference.empty() || refused_flag_) {
    differed_ = false;
    return;
  }
  if (!differed_) {  // it may have been read before it was taken over
    differed_ = true;
    next_verify_ = now + kVerifyAgain;
    return;
  }
  differed_ = false;
  ++statistics_.mismatched;
  device_.messages().warn(
      "read back",
      "The haptic device does not hold the parameters that were sent: " + difference + "; check cable and firmware.",
      now);
}

void HapticDriver::checkRefusals() {
  if (ask_status_) device_.connection()->refreshStatus();
  ask_status_ = false;
  const vibe_firmware::StatusReport& status = device_.connection()->status();
  const std::uint32_t refused = status.refused - refused_before_;
  if (refused == 0) return;
  refused_before_ = status.refused;
  statistics_.refused += refused;
  statistics_.last_refusal = describe(status.refusal);
  device_.messages().warn("refused",
                          "The haptic device refused parameter set " + std::to_string(status.refused_number) + ", " +
                              statistics_.last_refusal + "; the set before stays in force.",
                          device_.now());
}

}  // namespace vibe::hardware
