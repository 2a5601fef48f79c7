#include "crtk_teleop_node.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <geometry_msgs/WrenchStamped.h>
#include <std_msgs/Bool.h>
#include <boost/algorithm/string/join.hpp>

#include "vibe_core/files/files.hpp"
#include "vibe_core/program/error.hpp"
#include "vibe_ros_utils/parameter_reader.hpp"

namespace vibe::hardware {
namespace {

constexpr double kForcePeriod = 0.005;      // without measurements the arm gets a force after so long [s]
constexpr double kJointInterval = 0.004;    // between commands to the scope, at least [s]
constexpr double kArmButtonInterval = 0.1;  // between messages that change nothing [s]
constexpr double kOldest = 0.5;             // a measurement that claims to be older has the stamp of another clock [s]
constexpr double kAhead = 0.005;            // what clocks that are kept together differ by [s]
constexpr double kReach = 10;               // no arm is larger [m]
constexpr double kStill = 5;                // equal measurements for so long are named [s]
constexpr double kPatience = 10;            // between warnings of a kind [s]
constexpr double kLookInterval = 10;        // between looks for an arm that is silent [s]
constexpr double kFirstLook = 2;            // after it began to be silent [s]
constexpr double kMissed = 0.2;             // share of a force that is missed when it is held back; design choice
constexpr int kTapped = 2;    // of a pedal of the dVRK: it went down and came up soon, which no other message says
constexpr double kTap = 0.1;  // for which such a button counts as pressed [s]
constexpr std::uint32_t kArmQueue = 10;

/// Of the ports of the scope's joints [s]
double largestDelay(const TeleopMapping& mapping) {
  double delay = 0;
  for (const HandJoint& joint : mapping.joints)
    if (joint.coordinate >= 0) delay = std::max(delay, joint.port.delay);
  return delay;
}

/// What is wrong with a pose; empty: nothing.
std::string faultOf(const geometry_msgs::Pose& pose) {
  const Eigen::Vector3d p(pose.position.x, pose.position.y, pose.position.z);
  const auto& q = pose.orientation;
  const double norm = Eigen::Vector4d(q.x, q.y, q.z, q.w).norm();
  if (!p.allFinite() || !std::isfinite(norm)) return "a number is not finite";
  if (std::abs(norm - 1) > 1e-2) return "its quaternion has another length than 1";
  if (p.norm() > kReach) return "it is more than 10 m away from the base; the driver may publish millimetres";
  return "";
}

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
      state_(startTeleop(mapping_, ros::WallTime::now().toSec())),
      updater_(handle) {
  checkClock();
  input_.live = true;
  next_look_ = ros::WallTime::now().toSec() + kFirstLook;
  advertise(handle);
  subscribe(handle);
  updater_.setHardwareID("none");
  updater_.add("crtk_teleop", this, &CrtkTeleopNode::fillDiagnostics);
  ROS_INFO_STREAM("Mapping '" << mapping_.name << "'; waiting for " << measured() << ".");
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

std::string CrtkTeleopNode::measured() const {
  return nameOf(mapping_.arm_joints.empty() ? mapping_.pose_topic : "measured_js");
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
      mapping_.arm_joints.empty() ? handle.subscribe(measured(), kArmQueue, &CrtkTeleopNode::onPose, this, hints)
                                  : handle.subscribe(measured(), kArmQueue, &CrtkTeleopNode::onArmJoints, this, hints),
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
        handle, mapping_.buttons[b], [this, b](bool pressed) { input_.buttons[b] = pressed ? 1 : 0; },
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
  const std::string fault = message.header.stamp.isZero() ? "its stamp is 0" : faultOf(message.pose);  // CRTK: invalid
  if (!fault.empty()) return refuse(measured(), fault);
  const auto& p = message.pose.position;
  const auto& q = message.pose.orientation;
  ArmSample sample;
  sample.position = {p.x, p.y, p.z};
  sample.orientation = Eigen::Quaterniond(q.w, q.x, q.y, q.z).normalized();
  takeSample(message.header, sample);
}

void CrtkTeleopNode::onArmJoints(const sensor_msgs::JointState& message) {
  ArmSample sample;
  for (std::size_t j = 0; j < mapping_.arm_joints.size(); ++j) {
    const std::string& name = mapping_.arm_joints[j];
    const auto found = std::find(message.name.begin(), message.name.end(), name);
    const auto index = static_cast<std::size_t>(found - message.name.begin());
    if (found == message.name.end()) {
      std::string names;
      for (const std::string& other : message.name) names += (names.empty() ? "" : ", ") + other;
      ROS_WARN_STREAM_THROTTLE(10, "A message on " << measured() << " has no joint '" << name << "' but " << names
                                                   << "; correct the mapping.");
      return;
    }
    if (message.header.stamp.isZero() || index >= message.position.size() || !std::isfinite(message.position[index]))
      return refuse(measured(), "its stamp is 0, or the position of '" + name + "' is missing or not finite");
    sample.joints[j] = message.position[index];
  }
  takeSample(message.header, sample);
}

void CrtkTeleopNode::warn(const std::string& kind, const std::string& sentence) {
  const double now = ros::WallTime::now().toSec();
  double& last = said_[kind];
  if (now - last < kPatience) return;
  last = now;
  ROS_WARN_STREAM(sentence);
}

void CrtkTeleopNode::refuse(const std::string& topic, const std::string& what) {
  ++invalid_;
  warn(topic + what, "A message on " + topic + " is ignored: " + what + ". There have been " +
                         std::to_string(invalid_) + " that are ignored; look at the driver of the arm.");
}

/// When it was measured, of the clock of this computer.
double CrtkTeleopNode::timeOf(const std_msgs::Header& header, double now) {
  const double time = header.stamp.toSec(), age = now - time;
  if (age < -kAhead || age > kOldest) {
    warn("clock", "The stamps of " + measured() + " are " + std::to_string(-age) +
                      " s off the clock of this computer, so the times of arrival are used; synchronise the clocks.");
    return now;
  }
  const std::string late = "Measurements on " + measured() + " come " + std::to_string(age) + " s after their stamps";
  const double delay = largestDelay(mapping_);
  if (age > mapping_.timeout)
    warn("timeout", late + ", and the arm counts as silent after " + std::to_string(mapping_.timeout) +
                        " s; make the connection quicker, synchronise the clocks, or raise 'timeout' and 'delay' "
                        "below 'arm' in the mapping.");
  else if (mapping_.force_scale != 0 && age > delay)
    warn("delay", late + ". If the way back takes as long, forces come later than the mapping says (" +
                      std::to_string(delay) +
                      " s), and the arm may give energy; write a longer 'delay' below 'arm' in the mapping.");
  return std::min(time, now);
}

void CrtkTeleopNode::takeSample(const std_msgs::Header& header, ArmSample sample) {
  const double now = ros::WallTime::now().toSec();
  sample.time = timeOf(header, now);
  worst_age_ = std::max(worst_age_, now - sample.time);
  if (samples_++ > 0 && header.frame_id != base_frame_) {
    warn("frame", "The frame of " + measured() + " has changed from '" + base_frame_ + "' to '" + header.frame_id +
                      "', and the arm goes on from here; if that goes on, two drivers may publish it.");
    state_.last.reset();
  }
  if (samples_ == 1 || sample.position != still_.position || sample.joints != still_.joints ||
      sample.orientation.coeffs() != still_.orientation.coeffs())
    still_ = sample;
  base_frame_ = header.frame_id;
  input_.sample = sample;
  advance(now);
}

/// An arm that does not measure what the mapping names may measure something else.
void CrtkTeleopNode::lookForTheArm(double now) {
  if (state_.last) next_look_ = now + kFirstLook;
  if (now < next_look_) return;
  next_look_ = now + kLookInterval;
  const bool by_joints = !mapping_.arm_joints.empty();
  const std::string other = ros::names::resolve(nameOf(by_joints ? "measured_cp" : "measured_js"));
  const std::string wanted = ros::names::resolve(measured());
  ros::master::V_TopicInfo topics;
  ros::master::getTopics(topics);
  const auto has = [&topics](const std::string& name) {
    return std::any_of(topics.begin(), topics.end(), [&name](const auto& topic) { return topic.name == name; });
  };
  if (has(wanted)) return;
  const std::string pose = ros::names::resolve(nameOf("measured_cp"));
  if (!by_joints && has(pose)) {
    ROS_WARN_STREAM("Nobody publishes " << wanted << ", but " << pose << " is there; correct 'pose' in the mapping.");
    return;
  }
  if (!has(other)) return;
  ROS_WARN_STREAM("Nobody publishes " << wanted << ", but " << other << " is there: "
                                      << (by_joints
                                              ? "map this arm by its pose, with along and about."
                                              : "this arm measures only its joints; map it by them, with slide and "
                                                "turn and their names."));
}

void CrtkTeleopNode::onGripper(const sensor_msgs::JointState& message) {
  if (message.header.stamp.isZero() || message.position.empty() || !std::isfinite(message.position[0]))
    return refuse(nameOf(mapping_.gripper->topic), "its stamp is 0, or its position is missing or not finite");
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
  lookForTheArm(now);
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
  withheld_ = std::max(withheld_, output.withheld);
  if (!output.sentence.empty()) warn(output.sentence, output.sentence);
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
  if (!mapping_.arm_joints.empty()) {
    sensor_msgs::JointState joints;
    joints.header.stamp = stamp;
    joints.name = mapping_.arm_joints;
    joints.effort.assign(output.efforts.begin(),
                         output.efforts.begin() + static_cast<std::ptrdiff_t>(joints.name.size()));
    force_.publish(joints);
    return;
  }
  geometry_msgs::WrenchStamped message;
  message.header.stamp = stamp;
  message.header.frame_id = base_frame_;
  message.wrench.force.x = output.force.x();
  message.wrench.force.y = output.force.y();
  message.wrench.force.z = output.force.z();
  message.wrench.torque.x = output.torque.x();
  message.wrench.torque.y = output.torque.y();
  message.wrench.torque.z = output.torque.z();
  force_.publish(message);
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
  const double still = state_.last ? state_.last->time - still_.time : 0, delay = largestDelay(mapping_);
  if (!state_.last)
    status.summary(DiagnosticStatus::WARN, "the arm is silent");
  else
    status.summary(DiagnosticStatus::OK, !state_.engaged    ? "waiting"
                                         : state_.on_device ? "moving the device"
                                                            : "driving");
  if (still > kStill)
    status.mergeSummaryf(DiagnosticStatus::OK, "the arm measures the same for %.0f s, at rest or frozen", still);
  if (!scope_known_) status.mergeSummary(DiagnosticStatus::WARN, "no simulator");
  if (!arm_ready_) status.mergeSummary(DiagnosticStatus::WARN, "the arm is not ready");
  if (withheld_ > kMissed)
    status.mergeSummaryf(DiagnosticStatus::WARN, "up to %.0f %% of a force held back to stay passive", 100 * withheld_);
  if (mapping_.force_scale != 0 && worst_age_ > delay)
    status.mergeSummaryf(DiagnosticStatus::WARN, "measurements come %.0f ms late, arm.delay is %.0f ms",
                         1e3 * worst_age_, 1e3 * delay);
  double balance = 1;
  bool acts = false;
  for (std::size_t j = 0; j < state_.ports.size(); ++j) {
    if (mapping_.joints[j].coordinate < 0) continue;
    balance = std::min(balance, state_.ports[j].balance / mapping_.joints[j].port.capacity);
    acts |= state_.ports[j].acts;
  }
  status.add("mapping", mapping_.name);
  status.add("state of the arm", arm_state_);
  status.add("measurements since the last message", samples_ - samples_before_);
  status.add("invalid measurements", invalid_);
  status.add("the same measurement for [s]", still);
  status.add("oldest measurement at its arrival [s]", worst_age_);
  status.add("least share of the energy that is left", balance);
  status.add("largest share of a force that was held back", withheld_);
  status.add("passivity controller acts", acts);
  samples_before_ = samples_;
  worst_age_ = withheld_ = 0;
}

}  // namespace vibe::hardware
