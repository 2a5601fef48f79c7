#pragma once

#include <algorithm>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <ros/node_handle.h>
#include <ros/publisher.h>
#include <rosbag/bag.h>

namespace vibe::sim {

/// Queue of a topic of small messages: long, because a simulation that runs faster than the wall clock must not lose
/// messages to a recorder that is busy for a moment.
constexpr std::uint32_t kSmallQueue = 10000;

/// How much of a topic a recording keeps. What a replay computes again is thinned or left out.
struct RecordingRule {
  std::string topic;  ///< without its namespace, or "type:PACKAGE/NAME" for all topics of a type
  double period;      ///< kept is one message in this time [s]; 0: all; kNever: none
  bool replayed;      ///< a replay writes all of its messages (replay --fill)
};

constexpr double kNever = -1;

/// The same for a topic of the simulator, without its name.
struct Kept {
  double period = 0;      ///< see RecordingRule [s]
  bool replayed = false;  ///< see RecordingRule
};
constexpr Kept kKeptWhole{0, false};
constexpr Kept kLeftToReplay{kNever, true};
/// One message in this time [s], enough to look at a session and to plot it without a replay.
constexpr Kept thinnedTo(double period) {
  return {period, true};
}

/// A bag that messages are written to, at a time that its owner sets.
struct BagTarget {
  rosbag::Bag& bag;
  std::string prefix;                                    ///< of the names of all topics, such as "/"
  std::function<bool(const std::string& topic)> wanted;  ///< by its whole name; other topics are left out
  ros::Time time{ros::TIME_MIN};                         ///< of the messages to come
  bool thinned = false;                                  ///< as a recorder thins them (Kept::period)
};

/// Where the messages of one topic go: to listeners in the graph, or into a bag. Used like a ros::Publisher.
class MessageSink {
 public:
  MessageSink() = default;
  explicit MessageSink(ros::Publisher publisher) : publisher_(std::move(publisher)) {}
  MessageSink(BagTarget& target, std::string topic, double period)
      : target_(&target), topic_(std::move(topic)), period_(period) {}

  template <class M>
  void publish(const M& message) const {
    if (target_ == nullptr) {
      if (publisher_) publisher_.publish(message);
    } else if (!topic_.empty() && isDue()) {
      target_->bag.write(topic_, target_->time, message);
    }
  }

  std::uint32_t getNumSubscribers() const {
    if (target_ != nullptr) return topic_.empty() ? 0 : 1;
    return publisher_ ? publisher_.getNumSubscribers() : 0;
  }

 private:
  // A message that comes a hundredth of the period early counts as due.
  bool isDue() const {
    const bool due = !target_->thinned || last_ == ros::TIME_MIN || (target_->time - last_).toSec() >= 0.99 * period_;
    if (due) last_ = target_->time;
    return due;
  }

  ros::Publisher publisher_;
  BagTarget* target_ = nullptr;
  std::string topic_;
  double period_ = 0;                      // of a target that is thinned [s]
  mutable ros::Time last_{ros::TIME_MIN};  // that was written
};

/// Makes sinks, in the graph or into a bag, and knows of all that it has made whether somebody listens and what a
/// recording keeps.
class SinkSource {
 public:
  SinkSource() = default;                                         ///< of sinks that lead nowhere
  SinkSource(const ros::NodeHandle& handle) : handle_(handle) {}  // NOLINT: a handle is enough
  /// @param target  lives as long as the sinks
  SinkSource(BagTarget& target) : target_(&target) {}  // NOLINT: so is a bag

  bool isGraph() const { return handle_.has_value(); }

  /// @param on_connect  called from the thread of ROS when somebody begins to listen; never for a bag
  template <class M>
  MessageSink advertise(const std::string& topic, std::uint32_t queue, Kept kept = kKeptWhole, bool latch = false,
                        const std::function<void()>& on_connect = {}) {
    made_.push_back(make<M>(topic, queue, kept, latch, on_connect));
    if (kept.period != 0 || kept.replayed) rules_.push_back({topic, kept.period, kept.replayed});
    return made_.back();
  }

  /// Whether anybody listens to any of them.
  bool anyIsHeard() const {
    return std::any_of(made_.begin(), made_.end(),
                       [](const MessageSink& sink) { return sink.getNumSubscribers() > 0; });
  }
  /// Of the topics that are not kept whole.
  const std::vector<RecordingRule>& recordingRules() const { return rules_; }

 private:
  template <class M>
  MessageSink make(const std::string& topic, std::uint32_t queue, Kept kept, bool latch,
                   const std::function<void()>& on_connect) {
    if (target_ != nullptr) {
      const std::string whole = topic[0] == '/' ? topic : target_->prefix + topic;
      return MessageSink(*target_, target_->wanted(whole) ? whole : "", kept.period);
    }
    if (!handle_) return {};
    ros::SubscriberStatusCallback connected;
    if (on_connect) connected = [on_connect](const ros::SingleSubscriberPublisher&) { on_connect(); };
    return MessageSink(
        handle_->advertise<M>(topic, queue, connected, ros::SubscriberStatusCallback(), ros::VoidConstPtr(), latch));
  }

  std::optional<ros::NodeHandle> handle_;
  BagTarget* target_ = nullptr;
  std::vector<MessageSink> made_;
  std::vector<RecordingRule> rules_;
};

}  // namespace vibe::sim
