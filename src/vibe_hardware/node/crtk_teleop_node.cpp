#include "crtk_teleop_node.hpp"

#include <algorithm>
#include <cmath>

#include <std_msgs/Bool.h>
#include <boost/algorithm/string/join.hpp>

#include "arm_messages.hpp"
#include "vibe_core/files/files.hpp"
#include "vibe_core/program/error.hpp"
#include "vibe_ros_utils/parameter_reader.hpp"

namespace vibe::hardware {
namespace {

constexpr double kForcePeriod = 0.005;      // without measurements the arm gets a force after so long [s]
constexpr double kJointInterval = 0.004;    // between commands to the scope, at least [s]
constexpr double kArmButtonInterval = 0.1;  // between messages that change nothing [s]
constexpr int kTapped = 2;    // of a pedal of the dVRK: it went down and came up soon, which no other message says
constexpr double kTap = 0.1;  // for which such a button counts as pressed [s]
constexpr double kShortest = 0.02;  // and any other, so that none is lost that comes and goes between two steps [s]
constexpr std::uint32_t kArmQueue = 10;

}  // namespace

CrtkParameters readCrtkParameters(const ros::NodeHandle& private_handle) {
  ros_utils::ParameterReader reader(private_handle);
  CrtkParameters parameters;
  reader.read("mapping", parameters.mapping);
  reader.read("arm", parameters.arm);
  double diagnostic_period = 1;  // diagnostic_updater reads it itself
  reader.read("diagnostic_period", diagnostic_period, 0.1, 60, "s");
  reader.finish();
  return parameters;
}

namespace {

/// @throws Error with simulated time
void checkClock() {
  bool use_sim_time = false;
  ros::param::get("/use_sim_time", use_sim_time);
  if (use_sim_time)
    throw Error(
        "An arm is sampled in wall time, but /use_sim_time is true; run 'rosparam delete /use_sim_time' before any "
        "node "
        "starts.");
}

}  // namespace

CrtkTeleopNode::CrtkTeleopNode(ros::NodeHandle handle, const CrtkParameters& parameters)
    : parameters_(parameters),
      limits_(toolLimitsOf(handle)),
      mapping_(loadTeleopMapping(resolveAddress(parameters.mapping), limits_)),
      watch_(mapping_, nameOf(mapping_.arm_joints.empty() ? mapping_.pose_topic : "measured_js"),
             ros::WallTime::now().toSec()),
      state_(startTeleop(mapping_, ros::WallTime::now().toSec())),
      updater_(handle) {
  checkClock();
  input_.live = true;
  advertise(handle);
  subscribe(handle);
  updater_.setHardwareID("none");
  updater_.add("crtk_teleop", this, &CrtkTeleopNode::fillDiagnostics);
  ROS_INFO_STREAM("Mapping '" << mapping_.name << "'; waiting for " << watch_.topic() << ".");
  const std::vector<std::string> missing = unreachable(mapping_);
  if (!missing.empty())
    ROS_INFO_STREAM("Nothing in this mapping reaches " << boost::algorithm::join(missing, ", ")
                                                       << "; another hand or node has to.");
  timer_ = handle.createWallTimer(ros::WallDuration(kForcePeriod), &CrtkTeleopNode::tick, this);
}

void CrtkTeleopNode::release() {
  timer_.stop();
  const ros::Time stamp = ros::Time::now();
  publishForce(TeleopOutput(), stamp);
  if (button_publisher_) button_publisher_.publish(makeButtons({}, stamp));
}

std::string CrtkTeleopNode::nameOf(const std::string& topic) const {
  return topic.front() == '/' ? topic : parameters_.arm + "/" + topic;
}

void CrtkTeleopNode::advertise(ros::NodeHandle& handle) {
  if (!mapping_.device_only) scope_ = handle.advertise<sensor_msgs::JointState>("scope/servo_jp", kArmQueue);
  if (mapping_.device_only || !mapping_.device.topic.empty() || (mapping_.gripper && mapping_.gripper->joint >= 0))
    suturing_device_ = handle.advertise<sensor_msgs::JointState>("suturing_device/servo_jp", kArmQueue);
  if (pressesButtons(mapping_)) button_publisher_ = handle.advertise<sensor_msgs::Joy>("scope/buttons", kArmQueue);
  if (mapping_.force_scale == 0) return;
  if (!mapping_.arm_joints.empty()) {
    force_ = handle.advertise<sensor_msgs::JointState>(nameOf(mapping_.force_topic), kArmQueue);
    return;
  }
  force_ = handle.advertise<geometry_msgs::WrenchStamped>(nameOf(mapping_.force_topic), kArmQueue);
  // what the drivers of dVRK and Force Dimension want to be told before they take forces
  std_msgs::Bool yes, no;
  yes.data = true;
  gravity_ = handle.advertise<std_msgs::Bool>(nameOf("use_gravity_compensation"), 1, true);
  gravity_.publish(yes);
  absolute_ = handle.advertise<std_msgs::Bool>(nameOf("body/set_cf_orientation_absolute"), 1, true);
  absolute_.publish(mapping_.force_frame == ForceFrame::Body ? no : yes);
}

void CrtkTeleopNode::subscribe(ros::NodeHandle& handle) {
  const ros::TransportHints hints = ros::TransportHints().tcpNoDelay();
  subscribers_ = {
      mapping_.arm_joints.empty()
          ? handle.subscribe(watch_.topic(), kArmQueue, &CrtkTeleopNode::onPose, this, hints)
          : handle.subscribe(watch_.topic(), kArmQueue, &CrtkTeleopNode::onArmJoints, this, hints),
      handle.subscribe(nameOf("operating_state"), kArmQueue, &CrtkTeleopNode::onState, this, hints),
      handle.subscribe("scope/setpoint_js", kArmQueue, &CrtkTeleopNode::onScope, this, hints),
      handle.subscribe("suturing_device/measured_js", kArmQueue, &CrtkTeleopNode::onSuturingDevice, this, hints),
      handle.subscribe("haptic/parameters", kArmQueue, &CrtkTeleopNode::onParameters, this, hints)};
  if (mapping_.gripper)
    subscribers_.push_back(
        handle.subscribe(nameOf(mapping_.gripper->topic), kArmQueue, &CrtkTeleopNode::onGripper, this, hints));
  if (!mapping_.clutch.topic.empty())
    listenToButton(handle, mapping_.clutch, [this](bool pressed) { input_.clutch = pressed; });
  if (!mapping_.device.topic.empty())
    listenToButton(handle, mapping_.device, [this](bool pressed) { input_.device = pressed; });
  for (std::size_t b = 0; b < mapping_.buttons.size(); ++b) {
    if (mapping_.buttons[b].topic.empty()) continue;
    listenToButton(
        handle, mapping_.buttons[b],
        [this, b](bool pressed) {
          input_.buttons[b] = pressed ? 1 : 0;
          if (pressed) tapped_[b] = std::max(tapped_[b], ros::WallTime::now().toSec() + kShortest);
        },
        [this, b] { tapped_[b] = ros::WallTime::now().toSec() + kTap; });
    pressing_.emplace_back(b, subscribers_.back());
  }
}

void CrtkTeleopNode::listenToButton(ros::NodeHandle& handle, const ArmButton& button, std::function<void(bool)> pressed,
                                    std::function<void()> tapped) {
  const boost::function<void(const sensor_msgs::Joy&)> callback = [button, pressed,
                                                                   tapped](const sensor_msgs::Joy& message) {
    const auto index = static_cast<std::size_t>(button.index);
    if (index >= message.buttons.size()) {
      ROS_WARN_STREAM_THROTTLE(10, "A message on " << button.topic << " has " << message.buttons.size()
                                                   << " buttons, and the mapping names the one with index "
                                                   << button.index << "; correct the mapping.");
      return;
    }
    if (message.buttons[index] == kTapped)
      tapped();
    else
      pressed(message.buttons[index] != 0);
  };
  subscribers_.push_back(handle.subscribe<sensor_msgs::Joy>(nameOf(button.topic), kArmQueue, callback));
}

void CrtkTeleopNode::onPose(const geometry_msgs::PoseStamped& message) {
  ArmSample sample;
  const MessageFault fault = readPose(message, sample);
  fault.what.empty() ? takeSample(message.header, sample) : watch_.refuse(watch_.topic(), fault.what);
}

void CrtkTeleopNode::onArmJoints(const sensor_msgs::JointState& message) {
  ArmSample sample;
  const MessageFault fault = readArmJoints(message, mapping_.arm_joints, sample);
  if (fault.what.empty()) return takeSample(message.header, sample);
  if (!fault.of_mapping) return watch_.refuse(watch_.topic(), fault.what);
  watch_.warn("joint", "A message on " + watch_.topic() + " " + fault.what + "; correct the mapping.");
}

void CrtkTeleopNode::takeSample(const std_msgs::Header& header, ArmSample sample) {
  const double now = ros::WallTime::now().toSec();
  if (!watch_.take(header, now, sample)) state_.last.reset();
  input_.sample = sample;
  advance(now);
}

void CrtkTeleopNode::onGripper(const sensor_msgs::JointState& message) {
  if (message.header.stamp.isZero() || message.position.empty() || !std::isfinite(message.position[0]))
    return watch_.refuse(nameOf(mapping_.gripper->topic), "its stamp is 0, or its position is missing or not finite");
  input_.gripper = message.position[0];
}

void CrtkTeleopNode::onState(const vibe_msgs::OperatingState& message) {
  arm_ready_ = message.state == "ENABLED" && message.is_homed;
  const std::string state = message.state + (message.is_homed ? "" : ", not homed");
  if (state != arm_state_)
    ROS_INFO_STREAM("The arm is " << state << (arm_ready_ ? "." : "; it drives when it is ENABLED and homed."));
  arm_state_ = state;
}

void CrtkTeleopNode::onScope(const sensor_msgs::JointState& message) {
  scope_known_ |= readJoints(message, 0, kScopeJointCount, input_.joints);
}

void CrtkTeleopNode::onSuturingDevice(const sensor_msgs::JointState& message) {
  suturing_device_known_ |= readJoints(message, kScopeJointCount, kSuturingDeviceJointCount, input_.joints);
}

void CrtkTeleopNode::onParameters(const vibe_msgs::HapticParameters& message) {
  input_.tissue.reset();
  if (!message.touching) return;
  try {
    TissueResponse tissue;
    tissue.time = ros::WallTime::now().toSec();
    for (std::size_t j = 0; j < kScopeJointCount; ++j) tissue.joints[j] = readSpring(message, kJointNames[j]);
    input_.tissue = tissue;
  } catch (const Error& error) {
    ROS_WARN_STREAM_THROTTLE(10, "A message on haptic/parameters is ignored: " << error.what());
  }
}

void CrtkTeleopNode::tick(const ros::WallTimerEvent&) {
  updater_.update();
  const double now = ros::WallTime::now().toSec();
  // Whoever pressed a button and has gone does not hold it any more.
  for (const auto& [button, pressed] : pressing_)
    if (pressed.getNumPublishers() == 0) input_.buttons[button] = 0;
  watch_.lookForTheArm(state_.last.has_value(), now, nameOf("measured_cp"), nameOf("measured_js"));
  if (now - state_.time >= kForcePeriod) advance(now);
}

void CrtkTeleopNode::advance(double now) {
  input_.ready = scope_known_ && suturing_device_known_ && arm_ready_;
  const bool was_engaged = state_.engaged, was_on_device = state_.engaged && state_.on_device;
  TeleopInput input = input_;
  for (std::size_t b = 0; b < tapped_.size(); ++b)
    if (now < tapped_[b]) input.buttons[b] = 1;
  const TeleopOutput output = step(mapping_, limits_, std::max(now, state_.time), input, state_);
  input_.sample.reset();
  watch_.withheld(output.withheld);
  if (!output.sentence.empty()) watch_.warn(output.sentence, output.sentence);
  if (output.engaged != was_engaged && !mapping_.device_only)
    ROS_INFO_STREAM((output.engaged ? "The arm drives the scope." : "The arm has let go of the scope."));
  if (output.on_device != was_on_device)
    ROS_INFO_STREAM((output.on_device ? "The arm moves the suturing device, and the scope stays."
                                      : "The arm has let go of the suturing device."));
  const ros::Time stamp = ros::Time::now();
  if (stamp.isZero()) return;  // simulated time has not begun; stamp 0 would mark invalid data
  if (state_.last || was_engaged) publishForce(output, stamp);
  publishCommands(output, now, stamp);
}

void CrtkTeleopNode::publishForce(const TeleopOutput& output, const ros::Time& stamp) {
  if (!force_) return;
  if (mapping_.arm_joints.empty())
    force_.publish(makeArmForce(output, watch_.baseFrame(), stamp));
  else
    force_.publish(makeArmEfforts(output, mapping_.arm_joints, stamp));
}

void CrtkTeleopNode::publishCommands(const TeleopOutput& output, double now, const ros::Time& stamp) {
  if (output.engaged && now - last_joints_ >= kJointInterval) {
    last_joints_ = now;
    DriveState drive;
    drive.joints = output.joints;
    if (output.moves_scope) scope_.publish(scopeCommand(drive, stamp));
    if (output.moves_device) suturing_device_.publish(suturingDeviceCommand(drive, stamp));
  }
  if (!button_publisher_ || (output.buttons == sent_buttons_ && now - last_buttons_ < kArmButtonInterval)) return;
  button_publisher_.publish(makeButtons(output.buttons, stamp));
  sent_buttons_ = output.buttons;
  last_buttons_ = now;
}

void CrtkTeleopNode::fillDiagnostics(diagnostic_updater::DiagnosticStatusWrapper& status) {
  using diagnostic_msgs::DiagnosticStatus;
  if (!state_.last)
    status.summary(DiagnosticStatus::WARN, "the arm is silent");
  else
    status.summary(DiagnosticStatus::OK, !state_.engaged    ? "waiting"
                                         : state_.on_device ? "moving the device"
                                                            : "driving");
  if (!scope_known_) status.mergeSummary(DiagnosticStatus::WARN, "no simulator");
  if (!arm_ready_) status.mergeSummary(DiagnosticStatus::WARN, "the arm is not ready");
  status.add("mapping", mapping_.name);
  status.add("state of the arm", arm_state_);
  watch_.fill(state_, status);
}

}  // namespace vibe::hardware
