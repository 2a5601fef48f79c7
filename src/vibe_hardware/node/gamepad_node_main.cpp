// gamepad_node: drives the scope with a gamepad or joystick.
#include <diagnostic_updater/diagnostic_updater.h>
#include <geometry_msgs/WrenchStamped.h>
#include <linux/input-event-codes.h>
#include <ros/node_handle.h>
#include <ros/ros.h>
#include <sensor_msgs/JointState.h>
#include <vibe_msgs/HapticParameters.h>
#include <vibe_msgs/ProcedureEvent.h>
#include <cmath>
#include <cstdio>
#include <memory>
#include <optional>
#include <string>

#include "hardware_messages.hpp"
#include "joy_pad.hpp"
#include "vibe_core/clocks/step_timer.hpp"
#include "vibe_core/files/files.hpp"
#include "vibe_core/program/error.hpp"
#include "vibe_hardware/gamepad/pad_drive.hpp"
#include "vibe_hardware/gamepad/pad_feedback.hpp"
#include "vibe_hardware/gamepad/pad_mapping.hpp"
#include "vibe_hardware/gamepad/pad_recording.hpp"
#include "vibe_hardware/gamepad/pad_source.hpp"
#include "vibe_ros_utils/parameter_reader.hpp"
#include "vibe_ros_utils/startup.hpp"

namespace vibe::hardware {
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

/// Private parameters of gamepad_node.
struct GamepadParameters {
  std::string mapping = "package://vibe_hardware/config/gamepads/two_stick.yaml";
  std::string pad;     ///< path, or part of the name or phys; empty: the first gamepad
  std::string joy;     ///< topic of sensor_msgs/Joy to read instead of a device; empty: none
  std::string replay;  ///< a recorded pad session to play instead; empty: none
  std::string record;  ///< where to record the pad; empty: nowhere
  double rate = 100;   ///< of the published joints [Hz]
};

/// @throws Error for a parameter that is unknown or wrong
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

/// The pad, topic or recording that the parameters ask for. @throws Error for a recording that cannot be read
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

/// A gamepad as topics: docs/interfaces.md. All work is done in the callbacks of one thread.
class GamepadNode {
 public:
  /// @throws Error for a wrong mapping, recording or URDF, and if the pad cannot be recorded where the parameters say
  GamepadNode(ros::NodeHandle handle, const GamepadParameters& parameters)
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

 private:
  GamepadParameters parameters_;
  ToolLimits limits_;
  PadMapping mapping_;
  PadFeedback feedback_;
  std::unique_ptr<PadRecorder> recorder_;  // outlives the pad that calls it
  PadLink link_;

  std::optional<std::array<double, kJointCount>> measured_;  // joints of the simulator
  std::optional<DriveState> drive_;                          // from the first pad on
  std::uint64_t drops_told_ = 0;
  std::uint64_t published_ = 0;
  double last_tick_ = 0;        // steady time [s]
  double last_buttons_ = -1e9;  // published [s]
  double last_hint_ = -1e9;     // [s]
  std::string hint_;
  std::array<std::uint8_t, kButtonCount> sent_buttons_{};
  StampSource joint_stamps_, button_stamps_;

  ros::Publisher scope_, suturing_device_, buttons_;
  std::vector<ros::Subscriber> subscribers_;
  diagnostic_updater::Updater updater_;
  std::uint64_t events_before_ = 0;  // at the last diagnostics
  ros::WallTimer timer_;

  void subscribe(ros::NodeHandle& handle) {
    const ros::TransportHints hints = ros::TransportHints().tcpNoDelay();
    subscribers_ = {handle.subscribe("joint_states", kPadQueue, &GamepadNode::onJoints, this, hints),
                    handle.subscribe("scope/measured_cf", kPadQueue, &GamepadNode::onForce, this, hints),
                    handle.subscribe("procedure/events", 100, &GamepadNode::onEvent, this, hints),
                    handle.subscribe("haptic/parameters", kPadQueue, &GamepadNode::onParameters, this, hints)};
  }

  void tick(const ros::WallTimerEvent&) {
    const double now = steadyTime();
    const double dt = now - last_tick_;
    last_tick_ = now;
    updater_.update();
    if (!followPad(now)) return;
    if (link_.pad() != nullptr) drive(now, dt);
    publish(now);
  }

  /// @return whether there is something to publish
  bool followPad(double now) {
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

  void padFound() {
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

  void padGone() {
    if (drive_) drive_ = releaseDrive(*drive_);
    updater_.setHardwareID("none");
  }

  /// The first pad is recorded; a recording holds one pad.
  void startRecording() {
    if (parameters_.record.empty() || recorder_) return;
    recorder_ = std::make_unique<PadRecorder>(parameters_.record, link_.pad()->info(), link_.pad()->state());
    link_.pad()->setListener([this](const PadEvent& event) { recorder_->add(event); });
  }

  void drive(double now, double dt) {
    PadSource& pad = *link_.pad();
    drive_ = advance(mapping_, limits_, pad.state(), *drive_, dt);
    hintAt(waitingControls(mapping_, *drive_), now);
    if (pad.motors() != nullptr) feedback_.update(now, *pad.motors());
    if (pad.dropCount() == drops_told_) return;
    drops_told_ = pad.dropCount();
    ROS_WARN_STREAM_THROTTLE(10, "The kernel has dropped events of the gamepad; its state was read anew.");
  }

  /// Says a sentence when it is new, and not too often.
  void hintAt(const std::string& sentence, double now) {
    if (sentence == hint_ || (now - last_hint_ < kHintInterval && !sentence.empty())) return;
    hint_ = sentence;
    if (sentence.empty()) return;
    last_hint_ = now;
    ROS_INFO_STREAM(sentence);
  }

  void publish(double now) {
    if (ros::Time::now().isZero()) return;  // simulated time has not begun; stamp 0 would mark invalid data
    const ros::Time stamp = joint_stamps_.at(now);
    scope_.publish(scopeCommand(*drive_, stamp));
    suturing_device_.publish(suturingDeviceCommand(*drive_, stamp));
    ++published_;
    if (drive_->buttons != sent_buttons_ || now - last_buttons_ >= kButtonInterval) publishButtons(now);
  }

  void publishButtons(double now) {
    buttons_.publish(makeButtons(drive_->buttons, button_stamps_.at(now)));
    sent_buttons_ = drive_->buttons;
    last_buttons_ = now;
  }

  void fillDiagnostics(diagnostic_updater::DiagnosticStatusWrapper& status) {
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

  void onJoints(const sensor_msgs::JointState& message) {
    std::array<double, kJointCount> joints{};
    if (!readJoints(message, 0, kJointCount, joints)) return;
    measured_ = joints;
    if (drive_) drive_ = followJoints(joints, limits_, *drive_);
  }

  void onForce(const geometry_msgs::WrenchStamped& message) {
    const auto& force = message.wrench.force;
    feedback_.setForce(steadyTime(), std::sqrt(force.x * force.x + force.y * force.y + force.z * force.z));
  }

  void onEvent(const vibe_msgs::ProcedureEvent& message) {
    if (const auto pulse = pulseOf(message)) feedback_.pulse(steadyTime(), *pulse);
  }

  void onParameters(const vibe_msgs::HapticParameters& message) {
    feedback_.setSprings(steadyTime(), readJointSprings(message));
  }
};

}  // namespace
}  // namespace vibe::hardware

int main(int argc, char** argv) {
  std::setvbuf(stdout, nullptr, _IOLBF, BUFSIZ);  // the player reads what to press first, also through a pipe
  return vibe::ros_utils::runNode(argc, argv, "gamepad_node", [] {
    ros::NodeHandle handle;
    const auto parameters = vibe::hardware::readGamepadParameters(ros::NodeHandle("~"));
    const vibe::hardware::GamepadNode node(handle, parameters);
    ros::spin();
  });
}
