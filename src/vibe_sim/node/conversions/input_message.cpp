#include "conversions/input_message.hpp"

#include <algorithm>
#include <cmath>

#include "conversions/conversions.hpp"
#include "vibe_core/constraints/pull_patch.hpp"
#include "vibe_core/program/error.hpp"
#include "vibe_core/state/state_fields.hpp"

namespace vibe::sim {
namespace {

static_assert(vibe_msgs::StepInput::_joints_type::static_size == kJointCount);
static_assert(vibe_msgs::StepInput::_buttons_type::static_size == kButtonCount);

std::string listJoints(JointRange range) {
  std::string list;
  for (int i = range.first; i < range.first + range.count; ++i)
    list += (list.empty() ? "" : ", ") + std::string(kJointNames[i]);
  return list;
}

/// Index of the joint called `name` within the range.
int findJoint(const std::string& name, JointRange range) {
  for (int i = range.first; i < range.first + range.count; ++i) {
    if (name == kJointNames[i]) return i;
  }
  throw Error("there is no joint " + quoted(name) + "; name exactly " + listJoints(range) + ".");
}

void checkLengths(const sensor_msgs::JointState& message, JointRange range, JointSource source) {
  const bool names_fit = message.name.size() == static_cast<std::size_t>(range.count) ||
                         (message.name.empty() && source == JointSource::Commanded);
  if (names_fit && message.position.size() == static_cast<std::size_t>(range.count)) return;
  throw Error("it has " + std::to_string(message.name.size()) + " names and " +
              std::to_string(message.position.size()) + " positions; give one of each for " + listJoints(range) + ".");
}

}  // namespace

JointRange jointsOf(InputChannel channel) {
  return channel == InputChannel::Scope ? JointRange{0, kScopeJointCount}
                                        : JointRange{kScopeJointCount, kJointCount - kScopeJointCount};
}

sensor_msgs::JointState makeJoints(const JointArray& joints, JointRange range, std::int64_t stamp) {
  auto message = stamped<sensor_msgs::JointState>(stamp, kScopeBaseFrame);
  for (int i = range.first; i < range.first + range.count; ++i) {
    message.name.emplace_back(kJointNames[i]);
    message.position.push_back(joints[i]);
  }
  return message;
}

InputSample readJoints(const sensor_msgs::JointState& message, InputChannel channel, JointSource source) {
  const JointRange range = jointsOf(channel);
  if (source == JointSource::Measured && message.header.stamp.isZero()) {
    throw Error("its stamp is 0, which says that the measurement is invalid; the last valid one stays in force.");
  }
  checkLengths(message, range, source);
  InputSample sample;
  sample.channel = channel;
  sample.stamp = fromRosTime(message.header.stamp);
  std::array<bool, kJointCount> seen{};
  for (int i = 0; i < range.count; ++i) {
    const int joint = message.name.empty() ? range.first + i : findJoint(message.name[i], range);
    if (seen[joint]) throw Error("joint " + quoted(message.name[i]) + " is there twice; name each joint once.");
    if (!std::isfinite(message.position[i])) {
      throw Error(std::string("the position of joint '") + kJointNames[joint] +
                  "' is not a finite number; send the last valid position instead.");
    }
    seen[joint] = true;
    sample.joints[joint] = message.position[i];
  }
  return sample;
}

InputSample readMove(const sensor_msgs::JointState& message, InputChannel channel) {
  InputSample sample = readJoints(message, channel, JointSource::Commanded);
  sample.move = true;
  return sample;
}

InputSample readButtons(const sensor_msgs::Joy& message) {
  if (message.buttons.size() != kButtonCount) {
    throw Error("it has " + std::to_string(message.buttons.size()) + " buttons; send " + std::to_string(kButtonCount) +
                ".");
  }
  InputSample sample;
  sample.channel = InputChannel::Buttons;
  sample.stamp = fromRosTime(message.header.stamp);
  for (int i = 0; i < kButtonCount; ++i) {
    if (message.buttons[i] != 0 && message.buttons[i] != 1) {
      throw Error(std::string("button '") + kButtonNames[i] + "' is " + std::to_string(message.buttons[i]) +
                  "; send 0 or 1.");
    }
    sample.buttons[i] = static_cast<std::uint8_t>(message.buttons[i]);
  }
  return sample;
}

namespace {

void checkTipFrame(const std::string& frame, const std::string& what) {
  if (!frame.empty() && frame != kWorldFrame && frame != kScopeBaseFrame)
    throw Error("its frame is " + quoted(frame) + "; give the " + what + " of scope_tip in frame '" + kWorldFrame +
                "' or '" + kScopeBaseFrame + "'.");
}

}  // namespace

InputSample readTipTarget(const geometry_msgs::PoseStamped& message) {
  const std::string& frame = message.header.frame_id;
  checkTipFrame(frame, "pose");
  const auto& p = message.pose.position;
  const auto& q = message.pose.orientation;
  const Eigen::Vector3d position(p.x, p.y, p.z);
  const Eigen::Quaterniond rotation(q.w, q.x, q.y, q.z);
  if (!position.allFinite() || !rotation.coeffs().allFinite()) {
    throw Error("its pose has a value that is not a finite number; send finite numbers.");
  }
  if (std::abs(rotation.norm() - 1) > 1e-3) {
    throw Error("its orientation is no unit quaternion (norm " + std::to_string(rotation.norm()) + "); normalise it.");
  }
  InputSample sample;
  sample.channel = InputChannel::Scope;
  sample.stamp = fromRosTime(message.header.stamp);
  sample.target = frame == kScopeBaseFrame ? ScopeTarget::TipInBase : ScopeTarget::TipInWorld;
  sample.tip_pose = Eigen::Translation3d(position) * rotation.normalized();
  return sample;
}

InputSample readTipMove(const geometry_msgs::PoseStamped& message) {
  InputSample sample = readTipTarget(message);
  sample.move = true;
  return sample;
}

InputSample readTipVelocity(const geometry_msgs::TwistStamped& message) {
  const std::string& frame = message.header.frame_id;
  checkTipFrame(frame, "velocity");
  const auto& v = message.twist.linear;
  const auto& w = message.twist.angular;
  InputSample sample;
  sample.channel = InputChannel::Scope;
  sample.stamp = fromRosTime(message.header.stamp);
  sample.target = frame == kScopeBaseFrame ? ScopeTarget::VelocityInBase : ScopeTarget::VelocityInWorld;
  sample.tip_twist << v.x, v.y, v.z, w.x, w.y, w.z;
  if (!sample.tip_twist.allFinite())
    throw Error("its twist has a value that is not a finite number; send finite numbers.");
  return sample;
}

InputSample readPull(const vibe_msgs::TissuePull& message) {
  InputSample sample;
  sample.channel = InputChannel::Pull;
  sample.stamp = fromRosTime(message.header.stamp);
  if (message.particle == -1) return sample;
  if (message.particle < -1)
    throw Error("its particle is " + std::to_string(message.particle) + "; give a number from 0 on, or -1 to let go.");
  const std::string& frame = message.header.frame_id;
  if (frame != kWorldFrame && frame != kTissueFrame)
    throw Error("its frame is " + quoted(frame) + "; give the target in frame '" + kWorldFrame + "' or '" +
                kTissueFrame + "'.");
  sample.pull_particle = message.particle;
  sample.pull_target = {message.target.x, message.target.y, message.target.z};
  if (!sample.pull_target.allFinite())
    throw Error("its target has a value that is not a finite number; send finite numbers.");
  return sample;
}

sensor_msgs::Joy makeButtons(const StepInput& input, std::int64_t stamp) {
  auto message = stamped<sensor_msgs::Joy>(stamp);
  message.buttons.assign(input.buttons.begin(), input.buttons.end());
  return message;
}

vibe_msgs::StepInput makeStepInput(const StepInput& input, std::int64_t step, std::int64_t stamp) {
  auto message = stamped<vibe_msgs::StepInput>(stamp);
  message.step = static_cast<std::uint64_t>(step);
  message.version = kStepInputVersion;
  std::copy(input.joints.begin(), input.joints.end(), message.joints.begin());
  std::copy(input.buttons.begin(), input.buttons.end(), message.buttons.begin());
  message.pull_particle = input.pull_particle;
  message.pull_target = toMessage<geometry_msgs::Point>(input.pull_target);
  message.breath = static_cast<std::uint8_t>(input.breath);
  return message;
}

vibe_msgs::TissuePullState makePullState(const State& state, std::int64_t stamp) {
  auto message = stamped<vibe_msgs::TissuePullState>(stamp, kWorldFrame);
  message.particle = state.pull.particle;
  message.position = toMessage<geometry_msgs::Point>(heldPosition(state));
  message.target = toMessage<geometry_msgs::Point>(state.pull.target);
  message.force = toMessage<geometry_msgs::Vector3>(state.pull.force);
  return message;
}

}  // namespace vibe::sim
