#include "simulator/inputs.hpp"

#include <algorithm>

#include "conversions/input_message.hpp"
#include "vibe_core/clocks/step_timer.hpp"
#include "vibe_core/program/error.hpp"

namespace vibe::sim {

namespace {

constexpr double kOwnerPatience = 2;          // a source that is silent for longer has given the topic up [s]
constexpr std::uint32_t kInputQueue = 10000;  // none may be lost in lock-step; the queue bounds what really waits

}  // namespace

Inputs::Inputs(const ros::NodeHandle& handle, InputQueue& queue, Publishers& publishers, const InputWindow& window,
               std::function<std::int64_t()> now, std::function<void(InputChannel)> arrived)
    : handle_(handle),
      queue_(queue),
      publishers_(publishers),
      window_(window),
      now_(std::move(now)),
      arrived_(std::move(arrived)) {
  using sensor_msgs::JointState;
  handle_.setCallbackQueue(&callbacks_);
  subscribe<JointState>("scope/input/joint_states", [](const JointState& message) {
    return readJoints(message, InputChannel::Scope, JointSource::Measured);
  });
  subscribe<JointState>("scope/servo_jp", [](const JointState& message) {
    return readJoints(message, InputChannel::Scope, JointSource::Commanded);
  });
  subscribe<geometry_msgs::PoseStamped>("scope/servo_cp", readTipTarget);
  subscribe<geometry_msgs::TwistStamped>("scope/servo_cv", readTipVelocity);
  subscribe<JointState>("suturing_device/input/joint_states", [](const JointState& message) {
    return readJoints(message, InputChannel::SuturingDevice, JointSource::Measured);
  });
  subscribe<JointState>("suturing_device/servo_jp", [](const JointState& message) {
    return readJoints(message, InputChannel::SuturingDevice, JointSource::Commanded);
  });
  subscribe<JointState>("scope/move_jp",
                        [](const JointState& message) { return readMove(message, InputChannel::Scope); });
  subscribe<geometry_msgs::PoseStamped>("scope/move_cp", readTipMove);
  subscribe<JointState>("suturing_device/move_jp",
                        [](const JointState& message) { return readMove(message, InputChannel::SuturingDevice); });
  subscribe<sensor_msgs::Joy>("scope/buttons", readButtons);
  subscribe<vibe_msgs::TissuePull>("tissue/pull", readPull);
  spinner_ = std::make_unique<ros::AsyncSpinner>(1, &callbacks_);
  spinner_->start();
}

Inputs::~Inputs() {
  spinner_->stop();
}

template <typename Message>
void Inputs::subscribe(const std::string& name, std::function<InputSample(const Message&)> read) {
  using Event = const ros::MessageEvent<const Message>&;
  ros::SubscribeOptions options;
  options.template initByFullCallbackType<Event>(name, kInputQueue, [this, name, read](Event event) {
    receive(name, event.getPublisherName(), [&] { return read(*event.getMessage()); });
  });
  options.transport_hints = ros::TransportHints().tcpNoDelay();
  topics_[name].subscriber = handle_.subscribe(options);
}

void Inputs::receive(const std::string& name, const std::string& publisher, const std::function<InputSample()>& read) {
  Topic& topic = topics_.at(name);
  if (!obeys(name, topic, publisher)) return;
  try {
    take(name, topic, publisher, read());
  } catch (const Error& error) {
    publishers_.complain("A message on " + name + " from " + publisher + " is ignored: " + error.what());
  }
}

void Inputs::take(const std::string& name, Topic& topic, const std::string& publisher, InputSample sample) {
  sample.sender = senderOf(name, topic, publisher);
  const std::string fault = faultOf(sample.stamp, now_(), window_);
  if (!fault.empty())
    return publishers_.complain("A message on " + name + " from " + publisher + " is ignored: " + fault +
                                "; check the clock of that node and whether both read the same /use_sim_time.");
  if (!queue_.push(sample))
    return publishers_.complain("A message on " + name + " from " + publisher +
                                " is ignored: " + std::to_string(InputQueue::kCapacity) +
                                " messages with later stamps wait already; send less ahead.");
  topic.owner = sample.sender;
  topic.last_message = steadyTime();
  arrived_(sample.channel);
}

const SampleSender* Inputs::senderOf(const std::string& name, const Topic& topic, const std::string& publisher) {
  if (topic.owner != nullptr && topic.owner->node == publisher) return topic.owner;
  const auto known = std::find_if(senders_.begin(), senders_.end(), [&](const SampleSender& sender) {
    return sender.topic == name && sender.node == publisher;
  });
  return &(known != senders_.end() ? *known : senders_.emplace_back(SampleSender{name, publisher}));
}

bool Inputs::obeys(const std::string& name, Topic& topic, const std::string& publisher) {
  const double now = steadyTime();
  const bool owned = topic.owner != nullptr && topic.owner->node != publisher &&
                     topic.subscriber.getNumPublishers() > 1 && now - topic.last_message < kOwnerPatience;
  if (owned) {
    publishers_.complain("Two nodes publish " + name + ": " + topic.owner->node + " is obeyed and " + publisher +
                         " ignored; stop one of them.");
    return false;
  }
  return true;
}

}  // namespace vibe::sim
