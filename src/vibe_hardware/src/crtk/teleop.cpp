#include "vibe_hardware/crtk/teleop.hpp"

#include <algorithm>
#include <cmath>

namespace vibe::hardware {
namespace {

constexpr double kTissueTimeout = 0.1;  // as every device has it: vibe_msgs/HapticParameters [s]
constexpr double kFadeTime = 0.05;      // [s]
constexpr double kBlendTime = 0.02;     // in which the jump of a new spring fades to 1/e [s]; design choice
constexpr double kJump = 5;             // speeds beyond so many speed limits are no motion of a hand

/// Rotation from one orientation to the next as a vector, in the base [rad].
Eigen::Vector3d turnBetween(const Eigen::Quaterniond& from, const Eigen::Quaterniond& to) {
  Eigen::Quaterniond turn = to * from.conjugate();
  if (turn.w() < 0) turn.coeffs() = -turn.coeffs();
  const double sine = turn.vec().norm();
  return sine < 1e-12 ? Eigen::Vector3d(2 * turn.vec())
                      : Eigen::Vector3d(2 * std::atan2(sine, turn.w()) / sine * turn.vec());
}

bool isJump(const TeleopMapping& mapping, const std::array<double, kHandCoordinates>& motion, double dt) {
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

/// @return false if the arm has jumped
bool follow(const TeleopMapping& mapping, const ArmSample& sample, TeleopState& state) {
  std::array<double, kHandCoordinates> motion{};
  const bool first = !state.last;
  const double dt = first ? 0 : sample.time - state.last->time;
  if (!first && !(dt > 0)) return true;  // an old one
  if (!first && !mapping.arm_joints.empty()) {
    for (std::size_t i = 0; i < motion.size(); ++i) motion[i] = sample.joints[i] - state.last->joints[i];
  } else if (!first) {
    const Eigen::Vector3d way = mapping.hand.transpose() * (sample.position - state.last->position);
    const Eigen::Vector3d turn = mapping.hand.transpose() * turnBetween(state.last->orientation, sample.orientation);
    for (int i = 0; i < 3; ++i) motion[i] = way[i], motion[i + 3] = turn[i];
  }
  state.last = sample;
  const bool jumped = isJump(mapping, motion, dt);
  for (std::size_t j = 0; j < state.ports.size(); ++j) {
    const HandJoint& joint = mapping.joints[j];
    if (joint.coordinate < 0) continue;
    const auto c = static_cast<std::size_t>(joint.coordinate);
    const double position = state.hand[c] + (jumped ? 0 : motion[c]);
    if (jumped || first)
      rebase(joint.port, sample.time, position, state.ports[j]);
    else
      observe(joint.port, sample.time, position, state.ports[j]);
  }
  if (jumped) return false;
  for (std::size_t i = 0; i < motion.size(); ++i) state.hand[i] += motion[i];
  return true;
}

/// From where the joints are.
void engage(const TeleopMapping& mapping, bool on_device, TeleopState& state) {
  state.engaged = true;
  state.on_device = on_device;
  state.tissue_time = -1e9;
  const Followers followers = followersOf(state);
  for (std::size_t j = followers.first; j < followers.end; ++j) {
    const HandJoint& joint = mapping.joints[j];
    if (joint.coordinate < 0) continue;
    JointScale& scale = state.scales[j];
    scale.scale = joint.scale;
    scale.offset = state.joints[j] - joint.scale * state.hand[static_cast<std::size_t>(joint.coordinate)];
  }
}

/// The scope stays where it was sent; the suturing device may have been moved by others.
void changeOver(const TeleopMapping& mapping, const TeleopInput& input, TeleopState& state) {
  letGo(state);
  if (input.device)
    std::copy(input.joints.begin() + kScopeJointCount, input.joints.end(), state.joints.begin() + kScopeJointCount);
  engage(mapping, input.device, state);
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

void moveJoints(const TeleopMapping& mapping, const ToolLimits& limits, const TeleopInput& input, TeleopState& state) {
  const Followers followers = followersOf(state);
  for (std::size_t j = followers.first; j < followers.end; ++j) {
    const HandJoint& joint = mapping.joints[j];
    if (joint.coordinate < 0) continue;
    const double wanted = jointPosition(state.scales[j], state.hand[static_cast<std::size_t>(joint.coordinate)]);
    state.joints[j] = std::clamp(wanted, limits[j].lower, limits[j].upper);
  }
  if (!mapping.gripper || !input.gripper) return;
  const ArmGripper& gripper = *mapping.gripper;
  const double share = std::clamp((*input.gripper - gripper.closed) / (gripper.open - gripper.closed), 0.0, 1.0);
  const auto joint = static_cast<std::size_t>(gripper.joint);
  state.joints[joint] = std::clamp(gripper.at_closed + share * (gripper.at_open - gripper.at_closed),
                                   limits[joint].lower, limits[joint].upper);
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
        silent ? release(now, state.ports[j]) : command(joint.port, now, spring, damping, state.ports[j]);
    output.passivity_acts |= state.ports[j].acts;
    output.efforts[static_cast<std::size_t>(joint.coordinate)] += sent;
    (joint.coordinate < HandRoll ? force : torque)[joint.coordinate % 3] += sent;
  }
  output.force = mapping.hand * force;
  output.torque = mapping.hand * torque;
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
  if (input.sample && !follow(mapping, *input.sample, state)) {
    letGo(state);
    output.sentence =
        "The arm has jumped, faster than a hand moves it; the scope stays and the arm takes it up from here.";
  }
  const bool silent = !state.last || now - state.last->time > mapping.timeout;
  if (was_engaged && silent && output.sentence.empty())
    output.sentence = "The arm has fallen silent: its forces are off and the scope stays where it is.";
  if (silent) state.last.reset();
  const bool may = input.ready && !silent && !input.clutch;
  if (!may && state.engaged) letGo(state);
  if (!may && !state.engaged && input.ready) state.joints = input.joints;
  if (may && !state.engaged && output.sentence.empty()) {
    state.joints = input.joints;
    engage(mapping, input.device, state);
  }
  if (state.engaged && state.on_device != input.device) changeOver(mapping, input, state);
  if (state.engaged) {
    if (!state.on_device) takeSprings(mapping, input, now - state.time, state);
    moveJoints(mapping, limits, input, state);
  }
  state.time = now;
  sendForces(mapping, now, state, output);
  output.joints = state.joints;
  output.engaged = state.engaged;
  output.on_device = state.engaged && state.on_device;
  return output;
}

}  // namespace vibe::hardware
