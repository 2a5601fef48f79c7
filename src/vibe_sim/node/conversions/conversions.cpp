#include "conversions/conversions.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "conversions/tool_message.hpp"
#include "vibe_core/common/error.hpp"
#include "vibe_core/input/step_input_fields.hpp"
#include "vibe_core/scene/scene_parser.hpp"
#include "vibe_core/simulation/drawn_joints.hpp"

namespace vibe::sim {

namespace {

// The numbers on the wire are those of the library.
using Wire = vibe_msgs::ProcedureEvent;
static_assert(
    same(Event::Kind::Grab, Wire::GRAB) && same(Event::Kind::GrabMissed, Wire::GRAB_MISSED) &&
    same(Event::Kind::Release, Wire::RELEASE) && same(Event::Kind::Slip, Wire::SLIP) &&
    same(Event::Kind::ContactBegin, Wire::CONTACT_BEGIN) && same(Event::Kind::ContactEnd, Wire::CONTACT_END) &&
    same(Event::Kind::PressureReached, Wire::PRESSURE_REACHED) && same(Event::Kind::Warning, Wire::WARNING) &&
    same(Event::Kind::Recovery, Wire::RECOVERY) && same(Event::Kind::Rejected, Wire::REJECTED) &&
    same(Event::Kind::Mark, Wire::MARK) && same(Event::Kind::Burn, Wire::BURN) &&
    same(Event::Kind::DeepBurn, Wire::DEEP_BURN) && same(Event::Kind::HelixTurned, Wire::HELIX_TURNED) &&
    same(Event::Kind::Bite, Wire::BITE) && same(Event::Kind::BiteMissed, Wire::BITE_MISSED) &&
    same(Event::Kind::BiteWithdrawn, Wire::BITE_WITHDRAWN) &&
    same(Event::Kind::NeedleExchanged, Wire::NEEDLE_EXCHANGED) &&
    same(Event::Kind::BleedingMild, Wire::BLEEDING_MILD) && same(Event::Kind::BleedingBrisk, Wire::BLEEDING_BRISK) &&
    same(Event::Kind::BleedingStopped, Wire::BLEEDING_STOPPED) &&
    same(Event::Kind::BleedingOverdue, Wire::BLEEDING_OVERDUE) &&
    same(Event::Kind::TechniqueFound, Wire::TECHNIQUE_FOUND) && same(Event::Kind::TTagDropped, Wire::T_TAG_DROPPED) &&
    same(Event::Kind::CinchPulling, Wire::CINCH_PULLING) && same(Event::Kind::Cinched, Wire::CINCHED) &&
    same(Event::Kind::CinchLoose, Wire::CINCH_LOOSE) && same(Event::Kind::TearOut, Wire::TEAR_OUT) &&
    same(Event::Kind::ThreadBroke, Wire::THREAD_BROKE) && same(Event::Kind::PhaseChanged, Wire::PHASE_CHANGED) &&
    same(Event::Kind::Pierced, Wire::PIERCED) && same(Event::Kind::ArmClosed, Wire::ARM_CLOSED));
using Anatomy = vibe_msgs::TissueTopology;
static_assert(same(Region::Cardia, Anatomy::REGION_CARDIA) && same(Region::Fundus, Anatomy::REGION_FUNDUS) &&
              same(Region::Body, Anatomy::REGION_BODY) && same(Region::Antrum, Anatomy::REGION_ANTRUM) &&
              same(Region::Pylorus, Anatomy::REGION_PYLORUS));
static_assert(same(Wall::Anterior, Anatomy::WALL_ANTERIOR) &&
              same(Wall::GreaterCurvature, Anatomy::WALL_GREATER_CURVATURE) &&
              same(Wall::Posterior, Anatomy::WALL_POSTERIOR) &&
              same(Wall::LesserCurvature, Anatomy::WALL_LESSER_CURVATURE));
static_assert(same(End::None, Anatomy::END_NONE) && same(End::Oesophagus, Anatomy::END_OESOPHAGUS) &&
              same(End::Duodenum, Anatomy::END_DUODENUM));
static_assert(vibe_msgs::StepInput::_joints_type::static_size == kJointCount);
static_assert(vibe_msgs::StepInput::_buttons_type::static_size == kButtonCount);

struct JointRange {
  int first;
  int count;
};

JointRange jointsOf(InputChannel channel) {
  return channel == InputChannel::Scope ? JointRange{0, kScopeJointCount}
                                        : JointRange{kScopeJointCount, kJointCount - kScopeJointCount};
}

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
  throw Error("there is no joint '" + name + "'; name exactly " + listJoints(range) + ".");
}

void checkLengths(const sensor_msgs::JointState& message, JointRange range, JointSource source) {
  const bool names_fit = message.name.size() == static_cast<std::size_t>(range.count) ||
                         (message.name.empty() && source == JointSource::Commanded);
  if (names_fit && message.position.size() == static_cast<std::size_t>(range.count)) return;
  throw Error("it has " + std::to_string(message.name.size()) + " names and " +
              std::to_string(message.position.size()) + " positions; give one of each for " + listJoints(range) + ".");
}

sensor_msgs::JointState makeJoints(const std::array<double, kJointCount>& joints, JointRange range,
                                   std::int64_t stamp) {
  sensor_msgs::JointState message;
  message.header.stamp = toRosTime(stamp);
  message.header.frame_id = kScopeBaseFrame;
  for (int i = range.first; i < range.first + range.count; ++i) {
    message.name.emplace_back(kJointNames[i]);
    message.position.push_back(joints[i]);
  }
  return message;
}

geometry_msgs::Quaternion toMessage(const Eigen::Quaterniond& q) {
  geometry_msgs::Quaternion message;
  message.x = q.x();
  message.y = q.y();
  message.z = q.z();
  message.w = q.w();
  return message;
}

template <typename Message>
Message toMessage(const Eigen::Vector3d& v) {
  Message message;
  message.x = v.x();
  message.y = v.y();
  message.z = v.z();
  return message;
}

template <typename Enum>
std::vector<std::uint8_t> toBytes(const std::vector<Enum>& values) {
  std::vector<std::uint8_t> bytes(values.size());
  std::transform(values.begin(), values.end(), bytes.begin(), [](Enum v) { return static_cast<std::uint8_t>(v); });
  return bytes;
}

std::vector<std::uint32_t> flatten(const std::vector<std::array<int, 3>>& triangles) {
  std::vector<std::uint32_t> numbers;
  numbers.reserve(3 * triangles.size());
  for (const auto& triangle : triangles) {
    for (int corner : triangle) numbers.push_back(static_cast<std::uint32_t>(corner));
  }
  return numbers;
}

}  // namespace

ros::Time toRosTime(std::int64_t nanoseconds) {
  ros::Time time;
  time.fromNSec(static_cast<std::uint64_t>(std::max<std::int64_t>(nanoseconds, 0)));
  return time;
}

std::int64_t fromRosTime(const ros::Time& time) {
  return static_cast<std::int64_t>(time.toNSec());
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
    if (seen[joint]) throw Error("joint '" + message.name[i] + "' is there twice; name each joint once.");
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

InputSample readTipTarget(const geometry_msgs::PoseStamped& message) {
  const std::string& frame = message.header.frame_id;
  if (frame != kWorldFrame && frame != kScopeBaseFrame) {
    throw Error("its frame is '" + frame + "'; give the pose of scope_tip in frame '" + kWorldFrame + "' or '" +
                kScopeBaseFrame + "'.");
  }
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
  sample.target = frame == kWorldFrame ? ScopeTarget::TipInWorld : ScopeTarget::TipInBase;
  sample.tip_pose = Eigen::Translation3d(position) * rotation.normalized();
  return sample;
}

sensor_msgs::JointState makeScopeJoints(const StepInput& input, std::int64_t stamp) {
  return makeJoints(input.joints, jointsOf(InputChannel::Scope), stamp);
}

sensor_msgs::JointState makeOverstitchJoints(const StepInput& input, std::int64_t stamp) {
  return makeJoints(input.joints, jointsOf(InputChannel::Overstitch), stamp);
}

sensor_msgs::Joy makeButtons(const StepInput& input, std::int64_t stamp) {
  sensor_msgs::Joy message;
  message.header.stamp = toRosTime(stamp);
  message.buttons.assign(input.buttons.begin(), input.buttons.end());
  return message;
}

vibe_msgs::StepInput makeStepInput(const StepInput& input, std::int64_t step, std::int64_t stamp) {
  vibe_msgs::StepInput message;
  message.header.stamp = toRosTime(stamp);
  message.step = static_cast<std::uint64_t>(step);
  message.version = kStepInputVersion;
  std::copy(input.joints.begin(), input.joints.end(), message.joints.begin());
  std::copy(input.buttons.begin(), input.buttons.end(), message.buttons.begin());
  message.pull_particle = input.pull_particle;
  message.pull_target = toMessage<geometry_msgs::Point>(input.pull_target);
  return message;
}

StepInput readStepInput(const vibe_msgs::StepInput& message) {
  StepInput input;
  std::copy(message.joints.begin(), message.joints.end(), input.joints.begin());
  std::copy(message.buttons.begin(), message.buttons.end(), input.buttons.begin());
  input.pull_particle = message.pull_particle;
  input.pull_target = {message.pull_target.x, message.pull_target.y, message.pull_target.z};
  return input;
}

sensor_msgs::JointState makeJointState(const Model& model, const State& state, std::int64_t stamp) {
  const ToolModel& tool = *model.tool;
  sensor_msgs::JointState message = makeJoints(toolJoints(state), {0, kJointCount}, stamp);
  const ShaftBend bend = tool.shaftBend(state.joints, state.tool_displacement);
  for (const ToolJoint& joint : tool.joints()) {
    if (joint.station < 0) continue;
    message.name.push_back(joint.name);
    message.position.push_back(bend.angle(joint.station, joint.direction));
  }
  for (const DrawnJoint& joint : drawnJoints(model, state)) {
    message.name.push_back(joint.name);
    message.position.push_back(joint.position);
  }
  return message;
}

sensor_msgs::JointState makeHandJoints(const State& state, std::int64_t stamp) {
  sensor_msgs::JointState message = makeJoints(state.joints, jointsOf(InputChannel::Scope), stamp);
  message.effort.assign(state.hand_effort.begin(), state.hand_effort.end());
  return message;
}

geometry_msgs::PoseStamped makePose(const Eigen::Isometry3d& pose, const std::string& frame, std::int64_t stamp) {
  geometry_msgs::PoseStamped message;
  message.header.stamp = toRosTime(stamp);
  message.header.frame_id = frame;
  message.pose.position = toMessage<geometry_msgs::Point>(pose.translation());
  message.pose.orientation = toMessage(Eigen::Quaterniond(pose.linear()));
  return message;
}

geometry_msgs::WrenchStamped makeWrench(const State& state, std::int64_t stamp) {
  geometry_msgs::WrenchStamped message;
  message.header.stamp = toRosTime(stamp);
  message.header.frame_id = kScopeTipFrame;
  message.wrench.force = toMessage<geometry_msgs::Vector3>(state.tool_force);
  message.wrench.torque = toMessage<geometry_msgs::Vector3>(state.tool_torque);
  return message;
}

vibe_msgs::HapticParameters makeHapticRelease(std::int64_t stamp) {
  vibe_msgs::HapticParameters message;
  message.header.stamp = toRosTime(stamp);
  message.header.frame_id = kWorldFrame;
  message.joint_name.assign(kJointNames.begin(), kJointNames.begin() + kScopeJointCount);
  return message;
}

vibe_msgs::HapticParameters makeHapticParameters(const ToolImpedance& response, double force_limit,
                                                 std::int64_t stamp) {
  vibe_msgs::HapticParameters message = makeHapticRelease(stamp);
  message.touching = 1;
  message.position = toMessage<geometry_msgs::Point>(response.position);
  message.velocity = toMessage<geometry_msgs::Vector3>(response.velocity);
  message.force = toMessage<geometry_msgs::Vector3>(response.force);
  message.equilibrium = toMessage<geometry_msgs::Point>(response.equilibrium);
  message.force_limit = force_limit;
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 3; ++column) {
      message.stiffness[3 * row + column] = response.stiffness(row, column);
      message.damping[3 * row + column] = response.damping(row, column);
    }
  for (int j = 0; j < kScopeJointCount; ++j) {
    const JointResponse& joint = response.joints[j];
    message.joint_position[j] = joint.position;
    message.joint_velocity[j] = joint.velocity;
    message.joint_effort[j] = joint.effort;
    message.joint_stiffness[j] = joint.stiffness;
    message.joint_damping[j] = joint.damping;
    message.joint_equilibrium[j] = joint.equilibrium;
  }
  return message;
}

geometry_msgs::TransformStamped makeTransform(const Eigen::Isometry3d& pose, const std::string& parent,
                                              const std::string& child, std::int64_t stamp) {
  geometry_msgs::TransformStamped message;
  message.header.stamp = toRosTime(stamp);
  message.header.frame_id = parent;
  message.child_frame_id = child;
  message.transform.translation = toMessage<geometry_msgs::Vector3>(pose.translation());
  message.transform.rotation = toMessage(Eigen::Quaterniond(pose.linear()));
  return message;
}

std_msgs::String makeSceneText(const Scene& scene, std::uint64_t seed) {
  Scene whole = scene;
  whole.seed = seed;
  if (!whole.geometry.file.empty()) whole.geometry.file = std::filesystem::absolute(whole.geometry.file).string();
  std_msgs::String text;
  text.data = toYaml(whole);
  return text;
}

vibe_msgs::ProcedureEvent makeEvent(const Event& event, std::int64_t stamp) {
  vibe_msgs::ProcedureEvent message;
  message.header.stamp = toRosTime(stamp);
  message.kind = static_cast<std::uint8_t>(event.kind);
  message.particle = event.particle;
  message.value = event.value;
  message.text = describe(event);
  return message;
}

vibe_msgs::ProcedureEvent makeWarning(const std::string& text, std::int64_t stamp) {
  Event event;
  event.kind = Event::Kind::Warning;
  vibe_msgs::ProcedureEvent message = makeEvent(event, stamp);
  message.text = text;
  return message;
}

vibe_msgs::TissueTopology makeTopology(const Model& model, std::uint32_t revision, std::int64_t stamp) {
  vibe_msgs::TissueTopology message;
  message.header.stamp = toRosTime(stamp);
  message.header.frame_id = kTissueFrame;
  message.revision = revision;
  message.name = model.scene.name;
  message.triangles = flatten(model.organ.surface.triangles);
  for (const Eigen::Vector3d& vertex : model.organ.surface.vertices) {
    message.rest_positions.insert(message.rest_positions.end(), vertex.data(), vertex.data() + 3);
  }
  message.region = toBytes(model.organ.region);
  message.wall = toBytes(model.organ.wall);
  message.end = toBytes(model.organ.end);
  for (double thickness : model.organ.thickness) message.thickness.push_back(static_cast<float>(thickness));
  message.render_triangles = flatten(model.render_surface.triangles);
  message.render_offsets.assign(model.render_surface.offsets.begin(), model.render_surface.offsets.end());
  message.render_particles.assign(model.render_surface.particles.begin(), model.render_surface.particles.end());
  message.render_weights = model.render_surface.weights;
  return message;
}

vibe_msgs::StageTime makeStageTime(const std::string& name, const DurationHistogram& durations) {
  vibe_msgs::StageTime message;
  message.name = name;
  message.p50 = 1e3 * durations.quantile(0.5);
  message.p99 = 1e3 * durations.quantile(0.99);
  message.max = 1e3 * durations.max();
  return message;
}

const char* toolStateOf(const State& state, const StepInput& input) {
  if (!state.grip.empty()) return "grip";
  if (input.buttons[Insufflate] && !state.pressure_reached) return "insufflation";
  return state.in_contact ? "contact" : "free";
}

}  // namespace vibe::sim
