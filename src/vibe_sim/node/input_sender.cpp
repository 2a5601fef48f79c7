#include "input_sender.hpp"

#include "conversions.hpp"

namespace vibe::sim {
namespace {

constexpr std::uint32_t kSenderQueue = 1000;

}  // namespace

InputSender::InputSender(ros::NodeHandle handle)
    : scope_(handle.advertise<sensor_msgs::JointState>("scope/measured_js", kSenderQueue)),
      overstitch_(handle.advertise<sensor_msgs::JointState>("overstitch/measured_js", kSenderQueue)),
      buttons_(handle.advertise<sensor_msgs::Joy>("scope/buttons", kSenderQueue)) {}

bool InputSender::hasListeners() const {
  return scope_.getNumSubscribers() > 0 && overstitch_.getNumSubscribers() > 0 && buttons_.getNumSubscribers() > 0;
}

void InputSender::send(const StepInput& input, std::int64_t stamp, bool with_buttons) {
  scope_.publish(makeScopeJoints(input, stamp));
  overstitch_.publish(makeOverstitchJoints(input, stamp));
  if (with_buttons) sendButtons(input, stamp);
}

void InputSender::sendButtons(const StepInput& input, std::int64_t stamp) {
  buttons_.publish(makeButtons(input, stamp));
}

}  // namespace vibe::sim
