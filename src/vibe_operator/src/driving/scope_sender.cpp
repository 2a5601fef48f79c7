#include "vibe_operator/driving/scope_sender.hpp"

#include <ros/this_node.h>

#include <cmath>
#include <limits>

#include "vibe_operator/messages/command_messages.hpp"

namespace vibe::operating {
namespace {

constexpr double kPeriod = 1.0 / 60;     // [s]
constexpr double kLongestStep = 0.25;    // after a longer gap the joints do not catch up [s]
constexpr double kStall = 0.25;          // a simulator that is silent for longer takes no steps [s]
constexpr double kHung = 1;              // a program that is silent for longer holds no key, as with buttons [s]
constexpr double kClosing = 0.5;         // a topic that is left and taken again at once could lose its subscribers [s]
constexpr double kSimulatorTimeout = 2;  // for joints of a simulator, or for it to listen [s]
constexpr std::uint32_t kQueue = 10;
constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

}  // namespace

ScopeSender::ScopeSender(ScopeDrive::ButtonChange button_changed)
    : drive_(std::move(button_changed)), force_(kUnknown), spinner_(1, &queue_) {
  seen_.fill(kUnknown);
  handle_.setCallbackQueue(&queue_);
  timer_ = handle_.createWallTimer(
      ros::WallDuration(kPeriod), [this](const ros::WallTimerEvent&) { tick(); }, false, false);
}

ScopeSender::~ScopeSender() {
  spinner_.stop();
}

void ScopeSender::start(const std::string& name_space) {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    active_ = true;
    if (requested_ != name_space) connected_ = false;  // tick() connects again
    requested_ = name_space;
  }
  spinner_.start();
  timer_.start();
}

void ScopeSender::stop() {
  const std::lock_guard<std::mutex> lock(mutex_);
  active_ = false;
  drive_.releaseAll();
}

void ScopeSender::setSpeeds(const DriveSpeeds& speeds) {
  const std::lock_guard<std::mutex> lock(mutex_);
  drive_.setSpeeds(speeds);
}

// The joints first move up to the time of the event, so that the motion does not depend on the rate of tick().
void ScopeSender::keyDown(int key) {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (!active_) return;
  heard_ = steadySeconds();
  moveTo(ros::Time::now());
  drive_.keyDown(key);
}

void ScopeSender::keyUp(int key) {
  const std::lock_guard<std::mutex> lock(mutex_);
  moveTo(ros::Time::now());
  drive_.keyUp(key);
  if (driving_ && standsStill()) drive_.begin(limits_, drive_.joints());  // a tap moves nothing then
}

void ScopeSender::releaseAll() {
  const std::lock_guard<std::mutex> lock(mutex_);
  moveTo(ros::Time::now());
  drive_.releaseAll();
}

void ScopeSender::displace(int joint, double by) {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (!driving_ || !active_) return;
  moveTo(ros::Time::now());
  drive_.displace(joint, by);
}

DriveView ScopeSender::view() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  heard_ = steadySeconds();
  DriveView view;
  view.driving = driving_;
  view.trouble = trouble_;
  view.keys_down = drive_.keysDown();
  view.gear = drive_.gear();
  view.limits = limits_;
  view.state = state_;
  view.force = force_;
  view.joints = driving_ ? drive_.joints() : seen_;
  return view;
}

// In the thread of the spinner, which alone connects and disconnects: that waits for callbacks in progress.
void ScopeSender::tick() {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (active_ || (driving_ && !drive_.atRest())) wanted_ = steadySeconds();
  if (steadySeconds() - wanted_ > kClosing) {
    disconnect();
    return timer_.stop();
  }
  if (steadySeconds() - heard_ > kHung) drive_.releaseJoints();
  if (!connected_) connect();
  trouble_ = findTrouble();
  if (!trouble_.empty()) return endDriving();
  const ros::Time now = ros::Time::now();
  if (!driving_ && (!active_ || !begin(now))) return;
  const bool heard = scope_.getNumSubscribers() > 1;  // this object is a subscriber too
  if (!heard && steadySeconds() - driving_since_ > kSimulatorTimeout)
    trouble_ = "No simulator listens to " + scope_.getTopic() + ". A recording cannot be driven.";
  if (!moveTo(now)) return;
  scope_.publish(scopeMessage(drive_.joints(), now));
  suturing_device_.publish(suturingDeviceMessage(drive_.joints(), now));
}

/// @return whether time has passed; the stamps of messages never repeat
bool ScopeSender::moveTo(const ros::Time& now) {
  if (!driving_) return false;
  if (now < last_) {  // time was set back
    endDriving();
    return false;
  }
  if (now > last_) passed_at_ = steadySeconds();
  const double passed = standsStill() ? 0 : (now - last_).toSec();
  if (passed > 0) drive_.advance(std::min(passed, kLongestStep));
  last_ = now;
  return passed > 0;
}

/// Wall time passes too during a pause, and while a slow simulator takes no step: the joints must not run ahead.
bool ScopeSender::standsStill() const {
  const double now = steadySeconds();
  return (state_ && state_->paused) || now - seen_at_ > kStall || now - passed_at_ > kStall;
}

bool ScopeSender::begin(const ros::Time& now) {
  if (!present_ || now.isZero()) return false;
  drive_.begin(limits_, *present_);
  driving_ = true;
  driving_since_ = steadySeconds();
  last_ = now;
  return true;
}

void ScopeSender::connect() {
  disconnect();
  connected_ = true;
  waiting_since_ = steadySeconds();
  topics_ = ros::NodeHandle(requested_);
  topics_.setCallbackQueue(&queue_);
  scope_ = topics_.advertise<sensor_msgs::JointState>("scope/servo_jp", kQueue);
  suturing_device_ = topics_.advertise<sensor_msgs::JointState>("suturing_device/input/joint_states", kQueue);
  const ros::TransportHints hints = ros::TransportHints().tcpNoDelay();
  subscribers_.push_back(topics_.subscribe("procedure/state", kQueue, &ScopeSender::takeState, this, hints));
  subscribers_.push_back(topics_.subscribe<sensor_msgs::JointState>(
      "joint_states", kQueue,
      [this](const sensor_msgs::JointState::ConstPtr& message) {
        const std::lock_guard<std::mutex> lock(mutex_);
        if (!readJoints(*message, seen_)) return;
        present_ = seen_;
        seen_at_ = steadySeconds();
      },
      nullptr, hints));
  subscribers_.push_back(topics_.subscribe<geometry_msgs::WrenchStamped>(
      "scope/measured_cf", kQueue,
      [this](const geometry_msgs::WrenchStamped::ConstPtr& message) {
        const std::lock_guard<std::mutex> lock(mutex_);
        const auto& force = message->wrench.force;
        force_ = std::sqrt(force.x * force.x + force.y * force.y + force.z * force.z);
      },
      nullptr, hints));
  watch<sensor_msgs::JointState>("scope/servo_jp", same_topic_);
  watch<sensor_msgs::JointState>("suturing_device/input/joint_states", same_topic_);
  watch<sensor_msgs::JointState>("scope/input/joint_states", other_topic_);
  watch<geometry_msgs::PoseStamped>("scope/servo_cp", other_topic_);
}

void ScopeSender::disconnect() {
  endDriving();
  scope_ = {};
  suturing_device_ = {};
  for (ros::Subscriber& subscriber : subscribers_) subscriber.shutdown();
  subscribers_.clear();
  connected_ = has_limits_ = false;
  state_.reset();
  force_ = kUnknown;
  simulator_.forget();
  same_topic_.forget();
  other_topic_.forget();
}

/// Notes which other node publishes a topic.
template <class Message>
void ScopeSender::watch(const std::string& topic, ControlWatch& watch) {
  const boost::function<void(const ros::MessageEvent<const Message>&)> note = [this, &watch](const auto& event) {
    if (event.getPublisherName() == ros::this_node::getName()) return;
    const std::lock_guard<std::mutex> lock(mutex_);
    watch.received(event.getPublisherName(), steadySeconds());
  };
  subscribers_.push_back(topics_.subscribe<Message>(topic, kQueue, note));
}

void ScopeSender::takeState(const vibe_msgs::ProcedureState::ConstPtr& state) {
  const std::lock_guard<std::mutex> lock(mutex_);
  simulator_.received(steadySeconds());
  if (state_ && isOtherSession(*state_, *state)) endDriving();  // the tool stays where it is in the new state
  state_ = state;
}

/// Why the scope cannot be driven now, in one sentence; empty if it can.
std::string ScopeSender::findTrouble() {
  const double now = steadySeconds();
  if (simulator_.waits() || simulator_.isGone(now) || !state_)
    return "No simulator publishes " + topics_.resolveName("procedure/state") + ". Start one, or set 'Namespace'.";
  std::string rival = other_topic_.rival(now);
  if (rival.empty() && !driving_) rival = same_topic_.rival(now);  // the simulator obeys the first publisher
  if (!rival.empty()) return rival + " drives the scope. Stop it to drive by hand.";
  const std::string wrong = findLimits();
  if (!wrong.empty()) return wrong;
  if (!present_ && !driving_ && now - waiting_since_ > kSimulatorTimeout) {
    if (state_->paused) return "The simulator is paused. Resume it to drive.";
    return "No joints arrive on " + topics_.resolveName("joint_states") + ". Does the scene have a scope?";
  }
  return {};
}

/// Reads the limits of the joints once.
std::string ScopeSender::findLimits() {
  if (has_limits_) return {};
  std::string key, urdf;
  if (!topics_.searchParam("robot_description", key) || !topics_.getParam(key, urdf))
    return "There is no parameter robot_description. Set it to the URDF of vibe_description.";
  const std::string wrong = readJointLimits(urdf, limits_);
  has_limits_ = wrong.empty();
  return wrong;
}

void ScopeSender::endDriving() {
  if (driving_) waiting_since_ = steadySeconds();
  driving_ = false;
  present_.reset();
}

}  // namespace vibe::operating
