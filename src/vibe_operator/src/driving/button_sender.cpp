#include "vibe_operator/driving/button_sender.hpp"

#include <ros/this_node.h>
#include <vibe_msgs/StepInput.h>

namespace vibe::operating {
namespace {

constexpr std::uint32_t kButtonQueue = 100;
constexpr double kTaking = 1;         // a paused simulator publishes no input [s]
constexpr double kLastMessage = 0.5;  // [s]

}  // namespace

void ButtonSender::listen(const std::string& name_space) {
  in_control_ = false;
  last_input_ = {};
  publisher_ = {};
  bank_ = {};
  watch_.forget();
  handle_ = ros::NodeHandle(name_space);
  topic_ = handle_.resolveName("scope/buttons");
  subscriber_ =
      handle_.subscribe<sensor_msgs::Joy>("scope/buttons", kButtonQueue,
                                          boost::function<void(const ros::MessageEvent<const sensor_msgs::Joy>&)>(
                                              [this](const auto& event) { receive(event); }));
}

void ButtonSender::receive(const ros::MessageEvent<const sensor_msgs::Joy>& event) {
  const bool own_program = event.getPublisherName() == ros::this_node::getName();
  const sensor_msgs::Joy& message = *event.getMessage();
  if (own_program && message.header.frame_id == frame_) return;
  const std::string part = own_program && !message.header.frame_id.empty() ? message.header.frame_id + " of " : "";
  watch_.received(part + event.getPublisherName(), steadySeconds());
  // Buttons pressed by another part of this program are obeyed too; contradicting them would release the helix.
  if (!in_control_ || own_program) bank_.adopt(message.buttons);
}

void ButtonSender::setControl(bool on, double now) {
  if (!on) return endControl(now);
  if (in_control_ || isTakingControl() || !watch_.rival(now).empty()) return;
  taking_since_ = now;
  last_input_ = handle_.subscribe<vibe_msgs::StepInput>("applied_input", 1, [this](const auto& input) {
    bank_.adopt({input->buttons.begin(), input->buttons.end()});
    beginControl();
  });
}

void ButtonSender::beginControl() {
  last_input_ = {};
  in_control_ = true;
  publisher_ = handle_.advertise<sensor_msgs::Joy>("scope/buttons", kButtonQueue);
  publish();
}

void ButtonSender::endControl(double now) {
  last_input_ = {};
  if (!in_control_) return;
  in_control_ = false;
  bank_.liftHeld();
  closing_since_ = now;
  publish();
}

void ButtonSender::press(int button, const Moment& now) {
  if (!in_control_) return;
  bank_.press(button, now);
  publish();
}

void ButtonSender::release(int button, const Moment& now) {
  if (!in_control_) return;
  bank_.release(button);
  if (bank_.settle(now)) publish();
}

void ButtonSender::tick(const Moment& now) {
  if (isTakingControl() && now.wall - taking_since_ > kTaking) beginControl();
  if (in_control_) {
    bank_.settle(now);
    publish();
  } else if (publisher_ && now.wall - closing_since_ > kLastMessage) {
    publisher_ = {};
  }
}

void ButtonSender::publish() {
  if (!publisher_) return;
  sensor_msgs::Joy message;
  message.header.stamp = ros::Time::now();
  message.header.frame_id = frame_;
  message.buttons.assign(bank_.down().begin(), bank_.down().end());
  publisher_.publish(message);
}

std::string ButtonSender::sentence(double now) const {
  const std::uint32_t ours = publisher_ ? 1 : 0;
  const std::uint32_t publishers = subscriber_ ? subscriber_.getNumPublishers() : 0;
  const std::uint32_t listeners = publisher_ ? publisher_.getNumSubscribers() : 0;
  return watch_.sentence(topic_, in_control_, publishers > ours ? publishers - ours : 0,
                         listeners > 1 ? listeners - 1 : 0, now);
}

}  // namespace vibe::operating
