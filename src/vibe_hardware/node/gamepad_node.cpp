#include "gamepad_node.hpp"

#include <cmath>
#include <memory>

#include <linux/input-event-codes.h>

#include "hardware_messages.hpp"
#include "joy_pad.hpp"
#include "vibe_core/clocks/step_timer.hpp"
#include "vibe_core/files/files.hpp"
#include "vibe_core/program/error.hpp"
#include "vibe_hardware/gamepad/pad_recording.hpp"
#include "vibe_hardware/gamepad/pad_source.hpp"
#include "vibe_ros_utils/parameter_reader.hpp"

namespace vibe::hardware {

GamepadParameters readGamepadParameters(const ros::NodeHandle& private_handle) {
  ros_utils::ParameterReader reader(private_handle);
  GamepadParameters parameters;
  reader.read("mapping", parameters.mapping);
  reader.read("pad", parameters.pad);
  reader.read("joy", parameters.joy);
  reader.read("replay", parameters.replay);
  reader.read("record", parameters.record);
  reader.read("rate", parameters.rate, 60, 100, "Hz");
  double diagnostic_period = 1;  // diagnostic_updater reads it itself
  reader.read("diagnostic_period", diagnostic_period, 0.1, 60, "s");
  reader.finish();
  return parameters;
}

ToolLimits toolLimitsOf(const ros::NodeHandle& handle) {
  std::string key, urdf;
  if (handle.searchParam("robot_description", key) && handle.getParam(key, urdf))
    return ToolModel::fromUrdf(urdf, "parameter " + key).limits();
  return loadToolLimits("package://vibe_description/urdf/scope.urdf");
}

PadLink makePadLink(const ros::NodeHandle& handle, const GamepadParameters& parameters, const JoyNames& names) {
  if (!parameters.joy.empty() && !(parameters.replay.empty() && parameters.pad.empty()))
    throw Error("The parameter joy goes without pad and replay, which name other sources; set one of them.");
  if (!parameters.joy.empty()) return PadLink(joyPad(handle, parameters.joy, names));
  if (parameters.replay.empty())
    return PadLink([wanted = parameters.pad](std::string& why) { return openPad(wanted, why); });
  const auto recording = std::make_shared<PadRecording>(loadPadRecording(resolveAddress(parameters.replay)));
  return PadLink([recording, played = false](std::string& why) mutable -> std::unique_ptr<PadSource> {
    why = "The recording of the gamepad has ended.";
    if (played) return nullptr;
    played = true;
    return playPadRecording(*recording);
  });
}

namespace {

constexpr double kButtonInterval = 0.1;  // between messages that change nothing [s]
constexpr double kHintInterval = 3;      // between hints [s]
constexpr std::uint32_t kPadQueue = 10;

/// What to do first, in the words of the mapping.
std::string firstSteps(const PadMapping& mapping) {
  const auto button = [&](Button which) { return eventCodeName(EV_KEY, mapping.buttons[which].code); };
  const auto control = [&](Joint which) {
    const JointMapping& joint = mapping.joints[which];
    return eventCodeName(joint.control == JointMapping::Control::Buttons ? EV_KEY : EV_ABS, joint.forward);
  };
  std::string text = "To begin: ";
  if (mapping.buttons[Insufflate].code >= 0) text += "press " + button(Insufflate) + " to insufflate, then ";
  if (mapping.joints[Insertion].forward >= 0) text += "insert the scope with " + control(Insertion) + ", ";
  if (mapping.joints[TipUpDown].forward >= 0) text += "look around with " + control(TipUpDown) + ", ";
  if (mapping.buttons[HelixGrab].code >= 0) text += "grab tissue with " + button(HelixGrab) + ", ";
  return text + "all controls: docs/tutorials/drive_by_hand.md.";
}

}  // namespace

GamepadNode::GamepadNode(ros::NodeHandle handle, const GamepadParameters& parameters)
    : parameters_(parameters),
      limits_(toolLimitsOf(handle)),
      mapping_(loadPadMapping(resolveAddress(parameters.mapping), limits_)),
      feedback_(mapping_),
      link_(makePadLink(handle, parameters, mapping_.joy)),
      scope_(handle.advertise<sensor_msgs::JointState>("scope/servo_jp", kPadQueue)),
      suturing_device_(handle.advertise<sensor_msgs::JointState>("suturing_device/input/joint_states", kPadQueue)),
      buttons_(handle.advertise<sensor_msgs::Joy>("scope/buttons", kPadQueue)),
      updater_(handle) {
  if (!parameters_.record.empty()) PadRecorder::checkFile(parameters_.record);
  updater_.setHardwareID("none");
  updater_.add("gamepad", this, &GamepadNode::fillDiagnostics);
  subscribe(handle);
  last_tick_ = steadyTime();
  ROS_INFO_STREAM("Mapping '" << mapping_.name << "'.");
  timer_ = handle.createWallTimer(ros::WallDuration(1 / parameters.rate), &GamepadNode::tick, this);
}

void GamepadNode::subscribe(ros::NodeHandle& handle) {
  const ros::TransportHints hints = ros::TransportHints().tcpNoDelay();
  subscribers_ = {handle.subscribe("joint_states", kPadQueue, &GamepadNode::onJoints, this, hints),
                  handle.subscribe("scope/measured_cf", kPadQueue, &GamepadNode::onForce, this, hints),
                  handle.subscribe("procedure/events", 100, &GamepadNode::onEvent, this, hints),
                  handle.subscribe("haptic/parameters", kPadQueue, &GamepadNode::onParameters, this, hints)};
}

void GamepadNode::tick(const ros::WallTimerEvent&) {
  const double now = steadyTime();
  const double dt = now - last_tick_;
  last_tick_ = now;
  updater_.update();
  if (!followPad(now)) return;
  if (link_.pad() != nullptr) drive(now, dt);
  publish(now);
}

/// @return whether there is something to publish
bool GamepadNode::followPad(double now) {
  const bool may_begin = measured_ && scope_.getNumSubscribers() > 0;
  if (!parameters_.replay.empty() && !may_begin && !drive_) return false;  // a recording begins with the simulator
  const bool had = link_.pad() != nullptr;
  const std::string sentence = link_.poll(now);
  const bool has = link_.pad() != nullptr;
  if (!sentence.empty()) {
    if (has) {
      ROS_INFO_STREAM(sentence);
    } else {
      ROS_WARN_STREAM(sentence);
    }
  }
  if (!had && has) padFound();
  if (had && !has) padGone();
  if (!drive_ && has && may_begin) {
    drive_ = startDrive(*measured_, mapping_, link_.pad()->state());
    ROS_INFO_STREAM(firstSteps(mapping_));
  }
  if (!drive_ && has) hintAt("Waiting for the joints of the simulator on joint_states.", now);
  return drive_.has_value();
}

void GamepadNode::padFound() {
  const std::string missing = missingControls(mapping_, link_.pad()->state());
  if (!missing.empty()) ROS_WARN_STREAM(missing);
  PadMotors* motors = link_.pad()->motors();
  ROS_INFO_STREAM("Rumble: " << (motors != nullptr && motors->hasRumble() ? "yes" : "no")
                             << ", spring: " << (motors != nullptr && motors->hasSpring() ? "yes" : "no") << ".");
  updater_.setHardwareID(link_.pad()->info().name);
  feedback_.forgetPad();
  events_before_ = drops_told_ = 0;
  startRecording();
}

void GamepadNode::padGone() {
  if (drive_) drive_ = releaseDrive(*drive_);
  updater_.setHardwareID("none");
}

/// The first pad is recorded; a recording holds one pad.
void GamepadNode::startRecording() {
  if (parameters_.record.empty() || recorder_) return;
  recorder_ = std::make_unique<PadRecorder>(parameters_.record, link_.pad()->info(), link_.pad()->state());
  link_.pad()->setListener([this](const PadEvent& event) { recorder_->add(event); });
}

void GamepadNode::drive(double now, double dt) {
  PadSource& pad = *link_.pad();
  drive_ = advance(mapping_, limits_, pad.state(), *drive_, dt);
  hintAt(waitingControls(mapping_, *drive_), now);
  if (pad.motors() != nullptr) feedback_.update(now, *pad.motors());
  if (pad.dropCount() == drops_told_) return;
  drops_told_ = pad.dropCount();
  ROS_WARN_STREAM_THROTTLE(10, "The kernel has dropped events of the gamepad; its state was read anew.");
}

/// Says a sentence when it is new, and not too often.
void GamepadNode::hintAt(const std::string& sentence, double now) {
  if (sentence == hint_ || (now - last_hint_ < kHintInterval && !sentence.empty())) return;
  hint_ = sentence;
  if (sentence.empty()) return;
  last_hint_ = now;
  ROS_INFO_STREAM(sentence);
}

void GamepadNode::publish(double now) {
  if (ros::Time::now().isZero()) return;  // simulated time has not begun; stamp 0 would mark invalid data
  const ros::Time stamp = joint_stamps_.at(now);
  scope_.publish(scopeCommand(*drive_, stamp));
  suturing_device_.publish(suturingDeviceCommand(*drive_, stamp));
  ++published_;
  if (drive_->buttons != sent_buttons_ || now - last_buttons_ >= kButtonInterval) publishButtons(now);
}

void GamepadNode::publishButtons(double now) {
  buttons_.publish(buttonCommand(*drive_, button_stamps_.at(now)));
  sent_buttons_ = drive_->buttons;
  last_buttons_ = now;
}

void GamepadNode::fillDiagnostics(diagnostic_updater::DiagnosticStatusWrapper& status) {
  using diagnostic_msgs::DiagnosticStatus;
  const PadSource* pad = link_.pad();
  if (pad == nullptr) {
    status.summary(DiagnosticStatus::WARN, "absent; waiting for it");
  } else {
    status.summary(DiagnosticStatus::OK, drive_ ? "driving" : "waiting for the simulator");
    if (!missingControls(mapping_, pad->state()).empty())
      status.mergeSummary(DiagnosticStatus::WARN, "the mapping does not fit this gamepad");
    status.add("name", pad->info().name);
    status.add("path", pad->info().path);
    status.add("phys", pad->info().phys);
    status.add("events since the last message", pad->eventCount() - events_before_);
    status.add("overflows of the kernel's queue", pad->dropCount());
    status.add("rumble", pad->info().has_rumble);
    status.add("spring", pad->info().has_spring);
    events_before_ = pad->eventCount();
  }
  status.add("mapping", mapping_.name);
  status.add("reconnects", link_.connections() > 0 ? link_.connections() - 1 : 0);
  status.add("published joints", published_);
}

void GamepadNode::onJoints(const sensor_msgs::JointState& message) {
  const auto joints = readJointStates(message);
  if (!joints) return;
  measured_ = joints;
  if (drive_) drive_ = followJoints(*joints, limits_, *drive_);
}

void GamepadNode::onForce(const geometry_msgs::WrenchStamped& message) {
  const auto& force = message.wrench.force;
  feedback_.setForce(steadyTime(), std::sqrt(force.x * force.x + force.y * force.y + force.z * force.z));
}

void GamepadNode::onEvent(const vibe_msgs::ProcedureEvent& message) {
  if (const auto pulse = pulseOf(message)) feedback_.pulse(steadyTime(), *pulse);
}

void GamepadNode::onParameters(const vibe_msgs::HapticParameters& message) {
  feedback_.setSprings(steadyTime(), readJointSprings(message));
}

}  // namespace vibe::hardware
