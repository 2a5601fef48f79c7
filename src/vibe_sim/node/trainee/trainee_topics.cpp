#include "trainee/trainee_topics.hpp"

#include "conversions/conversions.hpp"
#include "conversions/input_message.hpp"
#include "conversions/session_message.hpp"

namespace vibe::sim {
namespace {

constexpr std::uint32_t kSenderQueue = 1000;

constexpr std::size_t kMaxResults = 10000;  // of a simulation that goes on although its particles do not come
constexpr std::size_t kMaxClouds = 100;

}  // namespace

InputSender::InputSender(ros::NodeHandle handle)
    : scope_(handle.advertise<sensor_msgs::JointState>("scope/input/joint_states", kSenderQueue)),
      suturing_device_(handle.advertise<sensor_msgs::JointState>("suturing_device/input/joint_states", kSenderQueue)),
      buttons_(handle.advertise<sensor_msgs::Joy>("scope/buttons", kSenderQueue)) {}

bool InputSender::hasListeners() const {
  return scope_.getNumSubscribers() > 0 && suturing_device_.getNumSubscribers() > 0 && buttons_.getNumSubscribers() > 0;
}

void InputSender::send(const StepInput& input, std::int64_t stamp, bool with_buttons) {
  scope_.publish(makeJoints(input.joints, jointsOf(InputChannel::Scope), stamp));
  suturing_device_.publish(makeJoints(input.joints, jointsOf(InputChannel::SuturingDevice), stamp));
  if (with_buttons) sendButtons(input, stamp);
}

void InputSender::sendButtons(const StepInput& input, std::int64_t stamp) {
  buttons_.publish(makeButtons(input, stamp));
}

void ObservationQueue::push(const vibe_msgs::StepResult::ConstPtr& result) {
  results_.push_back(result);
  if (results_.size() > kMaxResults) results_.pop_front();
}

void ObservationQueue::push(const sensor_msgs::PointCloud2::ConstPtr& cloud) {
  if (!complete_) clouds_.clear();
  clouds_.push_back(cloud);
  if (clouds_.size() > kMaxClouds) clouds_.pop_front();
}

// The cloud of this step comes first in the queue. Older ones belong to steps before the first that was received.
bool ObservationQueue::findCloud(const vibe_msgs::StepResult& result) {
  while (!clouds_.empty() && clouds_.front()->header.stamp < result.header.stamp) clouds_.pop_front();
  return !clouds_.empty() && clouds_.front()->header.stamp == result.header.stamp;
}

std::vector<Eigen::Vector3d> ObservationQueue::takeWall() {
  const sensor_msgs::PointCloud2::ConstPtr cloud = clouds_.front();
  clouds_.pop_front();
  return readWall(*cloud);
}

std::optional<Sight> ObservationQueue::next() {
  while (!results_.empty()) {
    const vibe_msgs::StepResult::ConstPtr result = results_.front();
    const bool wants_cloud = complete_ && result->has_particles, has_cloud = wants_cloud && findCloud(*result);
    if (wants_cloud && !has_cloud && clouds_.empty()) return {};
    results_.pop_front();
    if (wants_cloud && !has_cloud) continue;  // its cloud was sent before anybody listened
    Sight sight{readStepResult(*result), fromRosTime(result->header.stamp), result->revision};
    if (has_cloud || (!complete_ && !clouds_.empty())) sight.seen.wall = takeWall();
    return sight;
  }
  return {};
}

}  // namespace vibe::sim
