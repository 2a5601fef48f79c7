#include "hardware_messages.hpp"

#include <algorithm>
#include <cmath>

#include "vibe_core/clocks/step_timer.hpp"
#include "vibe_core/program/error.hpp"

namespace vibe::hardware {

namespace {

const ros::Duration kLeast(0, 1000);  // between stamps
const ros::Duration kSetBack(1);      // more than this is a clock that was set

/// Where a name stands in a message. @throws Error if it is missing or there twice
std::size_t placeOf(const std::vector<std::string>& names, const std::string& name) {
  const auto found = std::find(names.begin(), names.end(), name);
  if (found == names.end()) throw Error("joint '" + name + "' is missing; send all joints.");
  if (std::find(found + 1, names.end(), name) != names.end()) {
    throw Error("joint '" + name + "' is there twice; send each once.");
  }
  return static_cast<std::size_t>(found - names.begin());
}

void checkFinite(double value, const std::string& what) {
  if (!std::isfinite(value)) throw Error(what + " is not finite; send finite numbers.");
}

}  // namespace

JointSpring readSpring(const vibe_msgs::HapticParameters& message, const std::string& joint) {
  const std::size_t i = placeOf(message.joint_name, joint);
  if (i >= message.joint_position.size()) throw Error("joint '" + joint + "' has no values; send four joints.");
  JointSpring spring;
  spring.position = message.joint_position[i];
  spring.velocity = message.joint_velocity[i];
  spring.effort = message.joint_effort[i];
  spring.stiffness = message.joint_stiffness[i];
  spring.damping = message.joint_damping[i];
  checkFinite(spring.position, "joint_position of " + joint);
  checkFinite(spring.velocity, "joint_velocity of " + joint);
  checkFinite(spring.effort, "joint_effort of " + joint);
  checkFinite(spring.stiffness, "joint_stiffness of " + joint);
  checkFinite(spring.damping, "joint_damping of " + joint);
  if (spring.stiffness < 0 || spring.damping < 0) {
    throw Error("stiffness or damping of " + joint + " is negative; send values of at least 0.");
  }
  return spring;
}

ros::Time StampSource::at(double time) {
  ros::Time stamp = ros::Time::now() - ros::Duration(steadyTime() - time);
  if (stamp < last_ + kLeast && stamp > last_ - kSetBack) stamp = last_ + kLeast;
  last_ = stamp;
  return stamp;
}

namespace {

/// Joints in the order of vibe::Joint from `first` on.
template <class Iterator>
sensor_msgs::JointState jointMessage(Iterator begin, Iterator end, int first, const ros::Time& stamp) {
  sensor_msgs::JointState message;
  message.header.stamp = stamp;
  message.position.assign(begin, end);
  message.name.assign(kJointNames.begin() + first, kJointNames.begin() + first + (end - begin));
  return message;
}

}  // namespace

sensor_msgs::JointState makeScopeJoints(const ScopeJoints& joints, const ros::Time& stamp) {
  return jointMessage(joints.positions().begin(), joints.positions().end(), 0, stamp);
}

sensor_msgs::JointState makeHapticJoints(const ScopeJoints& joints, const ros::Time& stamp) {
  sensor_msgs::JointState message;
  message.header.stamp = stamp;
  for (int axis = 0; axis < vibe_firmware::kAxisCount; ++axis) {
    const int joint = joints.calibration().jointOf(DeviceKind::Haptic, axis);
    if (joint < 0) continue;
    message.name.emplace_back(kJointNames[static_cast<std::size_t>(joint)]);
    message.position.push_back(joints.positions()[static_cast<std::size_t>(joint)]);
    message.effort.push_back(joints.effort(joint));
  }
  return message;
}

sensor_msgs::JointState makeSuturingDeviceJoints(const SuturingDeviceDrive& drive, const ros::Time& stamp) {
  return jointMessage(drive.positions().begin(), drive.positions().end(), kScopeJointCount, stamp);
}

sensor_msgs::Joy makeButtons(const std::array<std::uint8_t, kButtonCount>& pressed, const ros::Time& stamp) {
  sensor_msgs::Joy message;
  message.header.stamp = stamp;
  message.buttons.assign(pressed.begin(), pressed.end());
  return message;
}

HapticDriver::Targets readHapticParameters(const vibe_msgs::HapticParameters& message, const ScopeJoints& joints) {
  HapticDriver::Targets targets{};
  for (int axis = 0; axis < vibe_firmware::kAxisCount; ++axis) {
    const int joint = joints.calibration().jointOf(DeviceKind::Haptic, axis);
    if (joint < 0) continue;
    const JointSpring spring = readSpring(message, kJointNames[static_cast<std::size_t>(joint)]);
    targets[static_cast<std::size_t>(axis)] = springOnAxis(joints.scale(joint), spring);
  }
  return targets;
}

SuturingDeviceDrive::Positions readSuturingDeviceJoints(const sensor_msgs::JointState& message) {
  if (message.name.size() != message.position.size()) throw Error("names and positions differ in number.");
  SuturingDeviceDrive::Positions positions{};
  for (std::size_t j = 0; j < positions.size(); ++j) {
    const std::string name = kJointNames[kScopeJointCount + j];
    positions[j] = message.position[placeOf(message.name, name)];
    checkFinite(positions[j], "the position of " + name);
  }
  return positions;
}

std::string operatingState(const DeviceStatistics& device, const HapticStatistics& haptic) {
  if (device.state == LinkState::Absent) return "DISABLED";
  constexpr int kFaults = vibe_firmware::kEncoderFault | vibe_firmware::kDriveFault;
  if (device.state != LinkState::Running || (device.flags & kFaults) != 0) return "FAULT";
  return haptic.in_force ? "ENABLED" : "PAUSED";
}

sensor_msgs::JointState scopeCommand(const DriveState& drive, const ros::Time& stamp) {
  return jointMessage(drive.joints.begin(), drive.joints.begin() + kScopeJointCount, 0, stamp);
}

sensor_msgs::JointState suturingDeviceCommand(const DriveState& drive, const ros::Time& stamp) {
  return jointMessage(drive.joints.begin() + kScopeJointCount, drive.joints.end(), kScopeJointCount, stamp);
}

bool readJoints(const sensor_msgs::JointState& message, int first, int count, std::array<double, kJointCount>& joints) {
  std::array<double, kJointCount> read = joints;
  for (int j = first; j < first + count; ++j) {
    const auto joint = static_cast<std::size_t>(j);
    const auto found = std::find(message.name.begin(), message.name.end(), kJointNames[joint]);
    const auto index = static_cast<std::size_t>(found - message.name.begin());
    if (index >= message.position.size() || !std::isfinite(message.position[index])) return false;
    read[joint] = message.position[index];
  }
  joints = read;
  return true;
}

JointSprings readJointSprings(const vibe_msgs::HapticParameters& message) {
  JointSprings springs;
  springs.touching = message.touching;
  for (std::size_t i = 0; i < kScopeJointCount; ++i) {
    const auto found = std::find(message.joint_name.begin(), message.joint_name.end(), kJointNames[i]);
    const auto index = static_cast<std::size_t>(found - message.joint_name.begin());
    if (index >= message.joint_stiffness.size()) continue;
    springs.stiffness[i] = message.joint_stiffness[index];
    springs.equilibrium[i] = message.joint_equilibrium[index];
  }
  return springs;
}

ToolLimits toolLimitsOf(const ros::NodeHandle& handle) {
  std::string key, urdf;
  if (handle.searchParam("robot_description", key) && handle.getParam(key, urdf))
    return ToolModel::fromUrdf(urdf, "parameter " + key).limits();
  return loadToolLimits("package://vibe_description/urdf/scope.urdf");
}

std::optional<PadPulse> pulseOf(const vibe_msgs::ProcedureEvent& event) {
  using vibe_msgs::ProcedureEvent;
  switch (event.kind) {
    case ProcedureEvent::CONTACT_BEGIN:
      return PadPulse::Contact;
    case ProcedureEvent::GRAB:
    case ProcedureEvent::HELIX_TURNED:
      return PadPulse::Grab;
    case ProcedureEvent::PIERCED:
    case ProcedureEvent::BITE:
      return PadPulse::Bite;
    case ProcedureEvent::GRAB_MISSED:
    case ProcedureEvent::SLIP:
    case ProcedureEvent::REJECTED:
    case ProcedureEvent::BITE_MISSED:
    case ProcedureEvent::TEAR_OUT:
    case ProcedureEvent::THREAD_BROKE:
      return PadPulse::Failure;
    default:
      return std::nullopt;
  }
}

namespace {

using diagnostic_msgs::DiagnosticStatus;
using diagnostic_updater::DiagnosticStatusWrapper;

constexpr double kLowestRate = 90;  // of 100 Hz

void addLink(const DeviceStatistics& device, DiagnosticStatusWrapper& status) {
  status.add("state", stateName(device.state));
  status.add("path", device.path);
  status.add("product", device.name);
  status.add("serial number", device.serial);
  status.add("firmware version", device.firmware);
  status.addf("rate [Hz]", "%.1f", device.rate);
  status.addf("age of the last sample [ms]", "%.1f", 1e3 * device.age);
  status.addf("clock drift [ppm]", "%.1f", 1e6 * device.drift);
  status.add("connections", device.connections);
  status.add("reconnects", device.connections > 0 ? device.connections - 1 : 0);
  status.add("late ticks", device.late_ticks);
}

void addCounts(const StreamCounts& counts, DiagnosticStatusWrapper& status) {
  status.add("received reports", counts.received);
  status.add("lost reports", counts.lost);
  status.add("duplicated reports", counts.duplicated);
  status.add("reordered reports", counts.reordered);
  status.add("malformed reports", counts.malformed);
  status.add("implausible reports", counts.implausible);
  status.add("restarts of the device", counts.restarts);
}

void addParameters(const HapticStatistics& haptic, std::uint64_t rejected, DiagnosticStatusWrapper& status) {
  status.add("sent parameters", haptic.sent);
  status.add("clamped parameters", haptic.clamped);
  status.add("refused parameters", haptic.refused);
  status.add("last refusal", haptic.last_refusal);
  status.add("parameters that read back differently", haptic.mismatched);
  status.add("reports of the device without valid parameters for 200 ms", haptic.starved);
  status.add("rejected messages on haptic/parameters", rejected);
}

void warnIf(bool condition, const std::string& sentence, DiagnosticStatusWrapper& status) {
  if (condition) status.mergeSummary(DiagnosticStatus::WARN, sentence);
}

void compare(const StreamCounts& now, const StreamCounts& before, DiagnosticStatusWrapper& status) {
  warnIf(now.lost > before.lost, "reports were lost", status);
  warnIf(now.duplicated > before.duplicated, "reports came twice", status);
  warnIf(now.reordered > before.reordered, "reports were reordered", status);
  warnIf(now.malformed > before.malformed, "reports were malformed", status);
  warnIf(now.implausible > before.implausible, "reports were implausible", status);
}

}  // namespace

void fillDiagnostics(const DeviceStatistics& device, const HapticStatistics* haptic, std::uint64_t rejected,
                     DiagnosticMemory& memory, DiagnosticStatusWrapper& status) {
  status.hardware_id = device.serial.empty() ? "none" : device.serial;
  const bool failed = device.state == LinkState::Unusable || device.state == LinkState::Silent;
  if (failed) {
    status.summary(DiagnosticStatus::ERROR, device.problem);
  } else if (device.state == LinkState::Absent) {
    status.summary(DiagnosticStatus::WARN, "absent; waiting for it");
  } else {
    status.summary(DiagnosticStatus::OK, "running");
    warnIf(device.rate < kLowestRate, "the rate is low", status);
    warnIf((device.flags & vibe_firmware::kEncoderFault) != 0, "an encoder has jumped, motors are off", status);
    warnIf((device.flags & vibe_firmware::kDriveFault) != 0, "the power stage has switched the motors off", status);
  }
  compare(device.counts, memory.counts, status);
  memory.counts = device.counts;
  addLink(device, status);
  addCounts(device.counts, status);
  if (haptic == nullptr) return;
  warnIf(haptic->refused > memory.haptic.refused, "parameters were refused", status);
  warnIf(haptic->mismatched > memory.haptic.mismatched, "parameters read back differently", status);
  warnIf(haptic->starved > memory.haptic.starved, "the device has missed parameters", status);
  memory.haptic = *haptic;
  addParameters(*haptic, rejected, status);
}

}  // namespace vibe::hardware
