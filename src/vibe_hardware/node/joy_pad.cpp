#include "joy_pad.hpp"

#include <functional>
#include <utility>

#include <ros/ros.h>
#include <sensor_msgs/Joy.h>
#include <sensor_msgs/JoyFeedbackArray.h>

namespace vibe::hardware {
namespace {

constexpr std::uint32_t kJoyQueue = 1000;

/// What has come on the topic; outlives the pads that are made of it.
class JoyTopic {
 public:
  JoyTopic(ros::NodeHandle& handle, const std::string& topic, JoyNames names)
      : feedback_(handle.advertise<sensor_msgs::JoyFeedbackArray>(topic + "/set_feedback", 10)),
        names_(std::move(names)),
        subscriber_(handle.subscribe(topic, kJoyQueue, &JoyTopic::onJoy, this, ros::TransportHints().tcpNoDelay())) {}

  bool isThere() const { return subscriber_.getNumPublishers() > 0 && messages_ > 0; }
  void forget() { state_ = PadState(), messages_ = 0; }

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
  std::uint64_t messages_ = 0;
  std::size_t axis_count_ = 0, button_count_ = 0;
  std::function<void(const PadEvent&)> listener_;
  ros::Subscriber subscriber_;

  void onJoy(const sensor_msgs::Joy& message) {
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
  bool update(double) override {
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
  std::shared_ptr<JoyTopic> topic_;
  PadInfo info_;
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
