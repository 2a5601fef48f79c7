#include "recorder.hpp"

#include <ros/master.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>

#include "vibe_core/common/error.hpp"

namespace vibe {
namespace {

constexpr std::uint32_t kUnlimited = 0;
constexpr double kQuiet = 0.2;    // without a message everything that was sent has arrived [s]
constexpr int kDrainRounds = 20;  // of kQuiet at most, for a graph that goes on sending

/// A mark in the callback queue: when it is called, everything that had arrived before it has been written.
class Marker : public ros::CallbackInterface {
 public:
  CallResult call() override {
    reached = true;
    return Success;
  }
  bool reached = false;
};

}  // namespace

Recorder::Recorder(const std::string& file, const std::string& last_topic) : file_(file), last_topic_(last_topic) {
  handle_.setCallbackQueue(&queue_);
  if (!last_topic_.empty()) last_topic_ = handle_.resolveName(last_topic_);
  if (std::filesystem::is_regular_file(file_ + ".active")) {
    throw Error("Recording '" + file_ + ".active' is there already, from a recorder that was killed; keep it with " +
                "`rosbag reindex`, or give another path.");
  }
  try {
    bag_->open(file_ + ".active", rosbag::bagmode::Write);
  } catch (const rosbag::BagException& error) {
    bag_.release();  // see the destructor
    throw Error("Recording '" + file_ + "' cannot be written (" + error.what() +
                "); give a path in a writable folder.");
  }
}

Recorder::~Recorder() {
  for (auto& entry : subscribers_) entry.second.shutdown();
  // A bag is closed by its destructor, and one that could not be written throws there, which ends the program.
  if (!write_error_.empty()) bag_.release();
}

bool Recorder::findTopics() {
  ros::master::V_TopicInfo topics;
  // getTopics() alone would wait for a master that is gone, deaf to signals
  if (!ros::master::check() || !ros::master::getTopics(topics)) return false;
  bool last_exists = false;
  for (const ros::master::TopicInfo& topic : topics) {
    if (subscribers_.count(topic.name) > 0) continue;
    if (topic.name == last_topic_) {
      last_exists = true;
    } else {
      subscribe(topic.name);
    }
  }
  if (last_exists && areConnected(topics)) subscribe(last_topic_);
  return true;
}

void Recorder::subscribe(const std::string& topic) {
  ros::SubscribeOptions options;
  options.topic = topic;
  options.queue_size = kUnlimited;
  options.md5sum = ros::message_traits::md5sum<topic_tools::ShapeShifter>();
  options.datatype = ros::message_traits::datatype<topic_tools::ShapeShifter>();
  options.helper = boost::make_shared<ros::SubscriptionCallbackHelperT<const Event&>>(
      [this, topic](const Event& event) { write(topic, event); });
  subscribers_[topic] = handle_.subscribe(options);
}

// Of what is published now: a topic whose only publisher has gone again is nothing to wait for.
bool Recorder::areConnected(const ros::master::V_TopicInfo& published) const {
  return std::all_of(published.begin(), published.end(), [this](const ros::master::TopicInfo& topic) {
    const auto entry = subscribers_.find(topic.name);
    return entry == subscribers_.end() || entry->second.getNumPublishers() > 0;
  });
}

void Recorder::write(const std::string& topic, const Event& event) {
  ++message_count_;
  if (!write_error_.empty()) return;
  try {
    // before the first /clock it is time 0, which a bag refuses
    bag_->write(topic, std::max(ros::Time::now(), ros::TIME_MIN), *event.getMessage(), event.getConnectionHeaderPtr());
  } catch (const rosbag::BagException& error) {
    write_error_ = "Recording '" + file_ + "' breaks off (" + error.what() + "); make room on the disk.";
  }
}

void Recorder::record(double duration) {
  const ros::WallTime end = ros::WallTime::now() + ros::WallDuration(duration);
  for (double left = duration; left > 0; left = (end - ros::WallTime::now()).toSec()) {
    queue_.callOne(ros::WallDuration(left));
    if (!write_error_.empty()) throw Error(write_error_);
  }
}

void Recorder::drain() {
  for (int round = 0; round < kDrainRounds; ++round) {
    const std::uint64_t before = message_count_;
    ros::WallDuration(kQuiet).sleep();
    const auto marker = boost::make_shared<Marker>();
    queue_.addCallback(marker);
    while (!marker->reached) queue_.callOne(ros::WallDuration(kQuiet));
    if (message_count_ == before) return;
  }
}

void Recorder::close() {
  drain();
  if (write_error_.empty()) {
    try {
      bag_->close();
    } catch (const rosbag::BagException& error) {
      write_error_ = "Recording '" + file_ + "' cannot be ended (" + error.what() + "); make room on the disk.";
    }
  }
  if (!write_error_.empty()) throw Error(write_error_);
  if (std::rename((file_ + ".active").c_str(), file_.c_str()) != 0) {
    throw Error("Recording '" + file_ + ".active' cannot be renamed to '" + file_ + "' (" + std::strerror(errno) +
                "); rename it by hand.");
  }
}

}  // namespace vibe
