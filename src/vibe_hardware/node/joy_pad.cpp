#include "joy_pad.hpp"

#include <functional>
#include <set>
#include <utility>

#include <ros/ros.h>
#include <sensor_msgs/Joy.h>
#include <sensor_msgs/JoyFeedbackArray.h>

namespace vibe::hardware {
namespace {

constexpr std::uint32_t kJoyQueue = 1000;
constexpr double kJoyLife = 0.5;  // of a message: whoever sent it may hang [s]

/// What has come on the topic; outlives the pads that are made of it.
class JoyTopic {
 public:
  JoyTopic(ros::NodeHandle& handle, const std::string& topic, JoyNames names)
      : feedback_(handle.advertise<sensor_msgs::JoyFeedbackArray>(topic + "/set_feedback", 10)),
        names_(std::move(names)),
        subscriber_(handle.subscribe(topic, kJoyQueue, &JoyTopic::onJoy, this, ros::TransportHints().tcpNoDelay())) {}

  bool isThere() const { return subscriber_.getNumPublishers() > 0 && messages_ > 0; }
  void forget() { state_ = PadState(), messages_ = 0; }
  /// Until the next message, as if nobody held the pad.
  void letGo() {
    for (auto& [code, axis] : state_.axes) axis.is_known = false;
    for (auto& [code, button] : state_.buttons)
      if (std::exchange(button.down, false)) let_go_.insert(code);
  }

  std::string topic() const { return subscriber_.getTopic(); }
  const PadState& state() const { return state_; }
  std::uint64_t messages() const { return messages_; }
  std::size_t axisCount() const { return axis_count_; }
  std::size_t buttonCount() const { return button_count_; }
  ros::Publisher& feedback() { return feedback_; }
  void setListener(std::function<void(const PadEvent&)> listener) { listener_ = std::move(listener); }

 private:
  ros::Publisher feedback_;
  JoyNames names_;
  PadState state_;
  std::set<int> let_go_;  // buttons that are down as far as the topic knows
  std::uint64_t messages_ = 0;
  std::size_t axis_count_ = 0, button_count_ = 0;
  std::function<void(const PadEvent&)> listener_;
  ros::Subscriber subscriber_;

  void onJoy(const sensor_msgs::Joy& message) {
    for (const int code : let_go_) state_.buttons[code].down = true;  // as it was: no new press
    let_go_.clear();
    axis_count_ = message.axes.size(), button_count_ = message.buttons.size();
    for (const PadEvent& event : joyEvents(message.axes, message.buttons, names_, state_)) {
      state_.apply(event);
      if (listener_) listener_(event);
    }
    ++messages_;
  }
};

class JoyPad : public PadSource, public PadMotors {
 public:
  explicit JoyPad(std::shared_ptr<JoyTopic> topic) : topic_(std::move(topic)) {
    info_.name = "sensor_msgs/Joy with " + std::to_string(topic_->axisCount()) + " axes and " +
                 std::to_string(topic_->buttonCount()) + " buttons";
    info_.path = topic_->topic();
    info_.has_rumble = true;
  }
  ~JoyPad() override { topic_->setListener({}); }
  JoyPad(const JoyPad&) = delete;
  JoyPad& operator=(const JoyPad&) = delete;

  const PadInfo& info() const override { return info_; }
  bool update(double now) override {
    if (std::exchange(seen_, topic_->messages()) != topic_->messages()) last_ = now;
    if (now - last_ > kJoyLife) letGo();
    if (topic_->isThere()) return true;
    topic_->forget();
    return false;
  }
  const PadState& state() const override { return topic_->state(); }
  PadMotors* motors() override { return this; }
  std::uint64_t eventCount() const override { return topic_->messages(); }
  std::uint64_t dropCount() const override { return 0; }
  void setListener(std::function<void(const PadEvent&)> listener) override { topic_->setListener(std::move(listener)); }

  bool hasRumble() const override { return true; }
  bool hasSpring() const override { return false; }
  bool rumble(double strong, double weak) override {
    sensor_msgs::JoyFeedbackArray message;
    for (const double level : {strong, weak}) {
      sensor_msgs::JoyFeedback motor;
      motor.type = sensor_msgs::JoyFeedback::TYPE_RUMBLE;
      motor.id = static_cast<std::uint8_t>(message.array.size());
      motor.intensity = static_cast<float>(level);
      message.array.push_back(motor);
    }
    topic_->feedback().publish(message);
    return true;
  }
  bool spring(const std::array<StickSpring, 2>&) override { return false; }

 private:
  void letGo() {
    topic_->letGo();
    if (!std::exchange(told_, true))
      ROS_WARN_STREAM("No message has come on " << topic_->topic() << " for " << kJoyLife
                                                << " s, so sticks and buttons count as let go until the next one; its "
                                                   "node may hang, or not repeat what stays: start joy_node with "
                                                   "_autorepeat_rate:=20.");
  }

  std::shared_ptr<JoyTopic> topic_;
  PadInfo info_;
  bool told_ = false;
  std::uint64_t seen_ = 0;  // messages
  double last_ = 0;         // of them, steady time [s]
};

}  // namespace

PadLink::Open joyPad(ros::NodeHandle handle, const std::string& topic, const JoyNames& names) {
  const auto source = std::make_shared<JoyTopic>(handle, topic, names);
  return [source](std::string& why) -> std::unique_ptr<PadSource> {
    why = "No message has come on " + source->topic() + "; start joy_node, and move the pad once.";
    if (!source->isThere()) return nullptr;
    return std::make_unique<JoyPad>(source);
  };
}

}  // namespace vibe::hardware
