#include "arm_watch.hpp"

#include <ros/ros.h>
#include <algorithm>
#include <utility>

#include "vibe_hardware/crtk/arm_age.hpp"

namespace vibe::hardware {
namespace {

constexpr double kOldest = 0.5;       // a measurement that claims to be older has the stamp of another clock [s]
constexpr double kAhead = 0.005;      // what clocks that are kept together differ by [s]
constexpr double kStill = 5;          // equal measurements for so long are named [s]
constexpr double kPatience = 10;      // between warnings of a kind [s]
constexpr double kLookInterval = 10;  // between looks for an arm that is silent [s]
constexpr double kFirstLook = 2;      // after it began to be silent [s]
constexpr double kMissed = 0.2;       // share of a force that is missed when it is held back; design choice

bool isPublished(const std::string& name) {
  ros::master::V_TopicInfo topics;
  ros::master::getTopics(topics);
  return std::any_of(topics.begin(), topics.end(), [&name](const auto& topic) { return topic.name == name; });
}

}  // namespace

ArmWatch::ArmWatch(const TeleopMapping& mapping, std::string topic, double now)
    : mapping_(mapping), topic_(std::move(topic)), next_look_(now + kFirstLook) {}

void ArmWatch::warn(const std::string& kind, const std::string& sentence) {
  const double now = ros::WallTime::now().toSec();
  const auto last = said_.find(kind);
  if (last != said_.end() && now - last->second < kPatience) return;
  said_[kind] = now;
  ROS_WARN_STREAM(sentence);
}

void ArmWatch::refuse(const std::string& topic, const std::string& what) {
  ++invalid_;
  warn(topic + what, "A message on " + topic + " is ignored: " + what + ". There have been " +
                         std::to_string(invalid_) + " that are ignored; look at the driver of the arm.");
}

double ArmWatch::timeOf(const std_msgs::Header& header, double now) {
  const double time = header.stamp.toSec(), age = now - time;
  if (age < -kAhead || age > kOldest) {
    warn("clock", "The stamps of " + topic_ + " are " + std::to_string(-age) +
                      " s off the clock of this computer, so the times of arrival are used; synchronise the clocks.");
    return now;
  }
  const Lateness late = latenessOf(mapping_, age);
  if (!late.key.empty())
    warn(late.key,
         "Measurements on " + topic_ + " come " + inMilliseconds(age) + " after their stamps, " + late.sentence);
  return std::min(time, now);
}

bool ArmWatch::take(const std_msgs::Header& header, double now, ArmSample& sample) {
  sample.time = timeOf(header, now);
  worst_age_ = std::max(worst_age_, now - sample.time);
  const bool other = samples_++ > 0 && header.frame_id != base_frame_;
  if (other)
    warn("frame", "The frame of " + topic_ + " has changed from '" + base_frame_ + "' to '" + header.frame_id +
                      "', and the arm goes on from here; if that goes on, two drivers may publish it.");
  if (samples_ == 1 || sample.position != still_.position || sample.joints != still_.joints ||
      sample.orientation.coeffs() != still_.orientation.coeffs())
    still_ = sample;
  base_frame_ = header.frame_id;
  return !other;
}

void ArmWatch::lookForTheArm(bool heard, double now, const std::string& pose, const std::string& joints) {
  if (heard) next_look_ = now + kFirstLook;
  if (now < next_look_) return;
  next_look_ = now + kLookInterval;
  const std::string wanted = ros::names::resolve(topic_);
  if (isPublished(wanted)) return;
  const bool by_joints = !mapping_.arm_joints.empty(), has_pose = isPublished(ros::names::resolve(pose));
  const std::string nobody = "Nobody publishes " + wanted + ", but ";
  if (has_pose)
    ROS_WARN_STREAM(nobody << ros::names::resolve(pose)
                           << (by_joints ? " is there: map this arm by its pose, with along and about."
                                         : " is there; correct 'pose' in the mapping."));
  else if (!by_joints && isPublished(ros::names::resolve(joints)))
    ROS_WARN_STREAM(nobody << ros::names::resolve(joints)
                           << " is there: this arm measures only its joints; map it by them, with slide and turn and "
                              "their names.");
}

void ArmWatch::withheld(double share) {
  withheld_ = std::max(withheld_, share);
}

void ArmWatch::fill(const TeleopState& state, diagnostic_updater::DiagnosticStatusWrapper& status) {
  using diagnostic_msgs::DiagnosticStatus;
  const double still = state.last ? state.last->time - still_.time : 0, delay = largestDelay(mapping_);
  if (still > kStill)
    status.mergeSummaryf(DiagnosticStatus::OK, "the arm measures the same for %.0f s, at rest or frozen", still);
  if (withheld_ > kMissed)
    status.mergeSummaryf(DiagnosticStatus::WARN, "up to %.0f %% of a force held back to stay passive", 100 * withheld_);
  if (getsForces(mapping_) && worst_age_ > delay)
    status.mergeSummaryf(DiagnosticStatus::WARN, "measurements come %.0f ms late, arm.delay is %.0f ms",
                         1e3 * worst_age_, 1e3 * delay);
  double balance = 1;
  bool acts = false;
  for (std::size_t j = 0; j < state.ports.size(); ++j) {
    if (mapping_.joints[j].coordinate < 0) continue;
    balance = std::min(balance, state.ports[j].balance / mapping_.joints[j].port.capacity);
    acts |= state.ports[j].acts;
  }
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
