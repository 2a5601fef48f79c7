#include "vibe_hardware/crtk/teleop.hpp"

#include <algorithm>
#include <cmath>

#include "crtk/arm_controls.hpp"

namespace vibe::hardware {
namespace {

constexpr double kTissueTimeout = 0.1;  // as every device has it: vibe_msgs/HapticParameters [s]
constexpr double kFadeTime = 0.05;      // [s]
constexpr double kBlendTime = 0.02;     // in which the jump of a new spring fades to 1/e [s]; design choice
constexpr double kJump = 3;             // speeds beyond so many speed limits are no motion of a hand; design choice

const char* const kJumped =
    "The arm has jumped, faster than a hand moves it; the scope stays and the arm takes it up from here. If that goes "
    "on, its driver may publish millimetres instead of metres, or two drivers the same topic.";
const char* const kSilent =
    "The arm has fallen silent: its forces are off and the scope stays where it is. An arm that does not hear this "
    "either keeps its last force and may give energy; let its driver drop forces that are not renewed.";
const char* const kOverdrawn =
    "The arm may have given more than its 'energy': while a force acted it moved faster, or its measurements paused "
    "for longer, than 'speed_limit' and 'delay' below 'arm' in the mapping allow; raise them, or make the connection "
    "steadier.";
constexpr double kAgeMemory = 10;                // in which a late measurement is forgotten to 1/e [s]; design choice
constexpr double kOverdraft = 0.01;              // of an account, from which it is said; design choice
constexpr double kCalm = 0.1;                    // without a jump until the arm engages again [s]
constexpr double kMostSwing = 170 * M_PI / 180;  // of the stylus; beyond, its twist is taken up anew [rad]

using Motion = std::array<double, kHandCoordinates>;

bool isJump(const TeleopMapping& mapping, const Motion& motion, double dt) {
  return std::any_of(mapping.joints.begin(), mapping.joints.end(), [&](const HandJoint& joint) {
    return joint.coordinate >= 0 && std::abs(motion[static_cast<std::size_t>(joint.coordinate)]) >
                                        kJump * joint.port.speed_limit * std::max(dt, 1e-3);
  });
}

/// Joints that follow the hand.
struct Followers {
  std::size_t first, end;
};
Followers followersOf(const TeleopState& state) {
  return state.on_device ? Followers{kScopeJointCount, kJointCount} : Followers{0, kScopeJointCount};
}

void letGo(TeleopState& state) {
  state.engaged = false;
  state.blends = {};
  state.springs = {};
}

/// The rotation counts from here on.
void refer(const TeleopMapping& mapping, TeleopState& state) {
  if (!state.last || !mapping.arm_joints.empty()) return;
  state.reference = state.last->orientation;
  state.turned = Eigen::Vector3d(state.hand[HandRoll], state.hand[HandPitch], state.hand[HandYaw]);
  state.rates = rotationSince(state.reference, state.reference, mapping.hand, mapping.twist, mapping.stylus, 0).rates;
}

/// How far the hand has moved between two measurements; of a rotation, the angle.
Motion motionBetween(const TeleopMapping& mapping, const ArmSample& from, const ArmSample& to) {
  Motion motion{};
  if (!mapping.arm_joints.empty()) {
    for (std::size_t i = 0; i < motion.size(); ++i) motion[i] = to.joints[i] - from.joints[i];
    return motion;
  }
  motion.fill(from.orientation.angularDistance(to.orientation));
  Eigen::Map<Eigen::Vector3d>(motion.data()) = mapping.hand.transpose() * (to.position - from.position);
  return motion;
}

/// Coordinates after a motion to the newest measurement.
void moveHand(const TeleopMapping& mapping, const Motion& motion, TeleopState& state) {
  const bool pose = mapping.arm_joints.empty();
  for (std::size_t i = 0; i < (pose ? 3U : motion.size()); ++i) state.hand[i] += motion[i];
  if (!pose) return;
  const double near = state.hand[static_cast<std::size_t>(HandRoll + mapping.twist)] - state.turned[mapping.twist];
  const HandRotation rotation =
      rotationSince(state.reference, state.last->orientation, mapping.hand, mapping.twist, mapping.stylus, near);
  if (rotation.swing > kMostSwing) return refer(mapping, state);
  for (std::size_t i = 0; i < 3; ++i)
    state.hand[HandRoll + i] = state.turned[static_cast<int>(i)] + rotation.angles[static_cast<int>(i)];
  state.rates = rotation.rates;
}

/// Of a joint's coordinate, over the link as it is.
PortConfig portOf(const HandJoint& joint, const TeleopState& state) {
  PortConfig port = joint.port;
  port.delay = std::max(port.delay, state.age);
  return port;
}

/// @return false if the arm has jumped
bool follow(const TeleopMapping& mapping, const ArmSample& sample, TeleopState& state) {
  const bool first = !state.last;
  const double dt = first ? 0 : sample.time - state.last->time;
  if (!first && !(dt > 0)) return true;  // an old one
  const Motion motion = first ? Motion{} : motionBetween(mapping, *state.last, sample);
  const bool jumped = isJump(mapping, motion, dt);
  state.last = sample;
  if (first || jumped)
    refer(mapping, state);
  else
    moveHand(mapping, motion, state);
  for (std::size_t j = 0; j < state.ports.size(); ++j) {
    const HandJoint& joint = mapping.joints[j];
    if (joint.coordinate < 0) continue;
    const auto book = first || jumped ? rebase : observe;
    book(portOf(joint, state), sample.time, state.hand[static_cast<std::size_t>(joint.coordinate)], state.ports[j]);
  }
  return !jumped;
}

/// The hand moves a joint from where it is.
void takeUp(const TeleopMapping& mapping, std::size_t j, TeleopState& state) {
  const HandJoint& joint = mapping.joints[j];
  if (joint.coordinate < 0) return;
  state.scales[j] = {joint.scale,
                     state.joints[j] - joint.scale * state.hand[static_cast<std::size_t>(joint.coordinate)]};
}

void engage(const TeleopMapping& mapping, bool on_device, TeleopState& state) {
  state.engaged = true;
  state.on_device = on_device;
  state.tissue_time = -1e9;
  refer(mapping, state);
  const Followers followers = followersOf(state);
  for (std::size_t j = followers.first; j < followers.end; ++j) takeUp(mapping, j, state);
}

/// From where the tool is.
void begin(const TeleopMapping& mapping, const TeleopInput& input, TeleopState& state) {
  state.joints = input.joints;
  state.gripper.reset();
  state.gripper_moved = false;
  for (std::size_t j = 0; j < state.joints.size(); ++j) resumeTrail(state.joints[j], state.trail.joints[j]);
  engage(mapping, wantsDevice(mapping, input), state);
}

/// Where somebody else has moved the tool, the arm goes on from there.
void watchTool(const TeleopMapping& mapping, const TeleopInput& input, TeleopState& state) {
  for (std::size_t j = 0; j < state.joints.size(); ++j) {
    JointTrail& trail = state.trail.joints[j];
    const bool rests = input.live && state.time - trail.rest_begin > kTrailRest;
    if (!movedByOthers(static_cast<int>(j), input.joints[j], rests, trail)) continue;
    state.joints[j] = input.joints[j];
    if (mapping.gripper && mapping.gripper->joint == static_cast<int>(j)) state.gripper_moved = false;
    resumeTrail(state.joints[j], trail);
    takeUp(mapping, j, state);
  }
}

double springForce(const JointSpring& spring, double coordinate) {
  return spring.effort + spring.damping * spring.velocity - spring.stiffness * (coordinate - spring.position);
}

/// Share of the spring that is rendered.
double freshness(double age) {
  return std::clamp(1 - (age - kTissueTimeout) / kFadeTime, 0.0, 1.0);
}

/// Takes over the newest springs; what would jump fades.
void takeSprings(const TeleopMapping& mapping, const TeleopInput& input, double dt, TeleopState& state) {
  for (double& blend : state.blends) blend *= std::exp(-dt / kBlendTime);
  const bool is_new = input.tissue ? input.tissue->time > state.tissue_time : state.tissue_time > -1e9;
  if (!is_new) return;
  for (std::size_t j = 0; j < state.springs.size(); ++j) {
    const HandJoint& joint = mapping.joints[j];
    if (joint.coordinate < 0) continue;
    const double at = state.hand[static_cast<std::size_t>(joint.coordinate)];
    JointSpring spring;
    if (input.tissue) spring = springOnAxis(state.scales[j], input.tissue->joints[j]);
    spring.effort *= mapping.force_scale;
    spring.stiffness *= mapping.force_scale;
    spring.damping *= mapping.force_scale;
    state.blends[j] += springForce(state.springs[j], at) - springForce(spring, at);
    state.springs[j] = spring;
  }
  state.tissue_time = input.tissue ? input.tissue->time : -1e9;
}

void moveJoints(const TeleopMapping& mapping, const ToolLimits& limits, TeleopState& state) {
  const Followers followers = followersOf(state);
  for (std::size_t j = followers.first; j < followers.end; ++j) {
    const HandJoint& joint = mapping.joints[j];
    if (joint.coordinate < 0) continue;
    const double wanted = jointPosition(state.scales[j], state.hand[static_cast<std::size_t>(joint.coordinate)]);
    state.joints[j] = std::clamp(wanted, limits[j].lower, limits[j].upper);
  }
}

void sendForces(const TeleopMapping& mapping, double now, TeleopState& state, TeleopOutput& output) {
  Eigen::Vector3d force = Eigen::Vector3d::Zero(), torque = Eigen::Vector3d::Zero();
  const double fresh = freshness(now - state.tissue_time);
  for (std::size_t j = 0; j < state.ports.size(); ++j) {
    const HandJoint& joint = mapping.joints[j];
    if (joint.coordinate < 0) continue;
    const double at = state.hand[static_cast<std::size_t>(joint.coordinate)];
    const double spring = state.engaged ? fresh * springForce(state.springs[j], at) + state.blends[j] : 0;
    const double damping = state.engaged ? fresh * state.springs[j].damping : 0;
    const bool silent = !state.engaged || state.on_device || mapping.force_scale == 0;
    const double sent =
        silent ? release(now, state.ports[j]) : command(portOf(joint, state), now, spring, damping, state.ports[j]);
    output.passivity_acts |= state.ports[j].acts;
    output.withheld = std::max(output.withheld, state.ports[j].withheld);
    if (state.ports[j].balance < -kOverdraft * joint.port.capacity && output.sentence.empty())
      output.sentence = kOverdrawn;
    output.efforts[static_cast<std::size_t>(joint.coordinate)] += sent;
    (joint.coordinate < HandRoll ? force : torque)[joint.coordinate % 3] += sent;
  }
  output.force = mapping.hand * force;
  output.torque = state.rates * torque;
  if (mapping.force_frame == ForceFrame::Base || !state.last) return;
  output.force = state.last->orientation.conjugate() * output.force;
  output.torque = state.last->orientation.conjugate() * output.torque;
}

}  // namespace

TeleopState startTeleop(const TeleopMapping& mapping, double now) {
  TeleopState state;
  state.time = now;
  for (std::size_t j = 0; j < state.ports.size(); ++j) state.ports[j] = startPort(mapping.joints[j].port, now);
  return state;
}

TeleopOutput step(const TeleopMapping& mapping, const ToolLimits& limits, double now, const TeleopInput& input,
                  TeleopState& state) {
  TeleopOutput output;
  const bool was_engaged = state.engaged;
  state.age *= std::exp(-(now - state.time) / kAgeMemory);
  if (input.sample) state.age = std::max(state.age, std::min(now - input.sample->time, mapping.timeout));
  if (input.sample && !follow(mapping, *input.sample, state)) {
    if (was_engaged) output.sentence = kJumped;
    letGo(state);
    state.jump_time = now;
  }
  const bool silent = !state.last || now - state.last->time > mapping.timeout;
  if (was_engaged && silent && output.sentence.empty()) output.sentence = kSilent;
  if (silent) state.last.reset();
  const bool on_device = wantsDevice(mapping, input);
  output.buttons = pressedOf(mapping, input, input.ready && !silent, state);
  const bool frees = input.clutch != mapping.clutch.reversed;
  const bool may = input.ready && !silent && !frees && now - state.jump_time >= kCalm;
  if (!may && state.engaged) letGo(state);
  if (!may && input.ready) state.joints = input.joints;
  if (may && !state.engaged) begin(mapping, input, state);
  if (state.engaged) watchTool(mapping, input, state);
  if (state.engaged && state.on_device != on_device) {
    letGo(state);
    engage(mapping, on_device, state);
  }
  if (state.engaged) {
    if (!state.on_device) takeSprings(mapping, input, now - state.time, state);
    moveJoints(mapping, limits, state);
    if (mapping.gripper && mapping.gripper->joint >= 0 && input.gripper)
      moveGripper(*mapping.gripper, input, now - state.time, state);
  }
  extendTrail(limits, state.joints, now, now - state.time, state.trail);
  state.time = now;
  sendForces(mapping, now, state, output);
  output.joints = state.joints;
  output.engaged = state.engaged;
  output.on_device = state.engaged && state.on_device;
  output.moves_scope = state.engaged && !mapping.device_only;
  output.moves_device = output.on_device || (state.engaged && mapping.gripper && mapping.gripper->joint >= 0);
  return output;
}

}  // namespace vibe::hardware
