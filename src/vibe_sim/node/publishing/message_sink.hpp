#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include <ros/node_handle.h>
#include <ros/publisher.h>
#include <rosbag/bag.h>

namespace vibe::sim {

/// Queue of a topic of small messages: long, because a simulation that runs faster than the wall clock must not lose
/// messages to a recorder that is busy for a moment.
constexpr std::uint32_t kSmallQueue = 10000;

/// A bag that messages are written to, at a time that its owner sets.
struct BagTarget {
  rosbag::Bag& bag;
  std::string prefix;                                    ///< of the names of all topics, such as "/"
  std::function<bool(const std::string& topic)> wanted;  ///< by its whole name; other topics are left out
  ros::Time time{ros::TIME_MIN};                         ///< of the messages to come
};

/// Where the messages of one topic go: to listeners in the graph, or into a bag. Used like a ros::Publisher.
class MessageSink {
 public:
  MessageSink() = default;
  explicit MessageSink(ros::Publisher publisher) : publisher_(std::move(publisher)) {}
  MessageSink(BagTarget& target, std::string topic) : target_(&target), topic_(std::move(topic)) {}

  template <class M>
  void publish(const M& message) const {
    if (target_ == nullptr) {
      if (publisher_) publisher_.publish(message);
    } else if (!topic_.empty()) {
      target_->bag.write(topic_, target_->time, message);
    }
  }

  std::uint32_t getNumSubscribers() const {
    if (target_ != nullptr) return topic_.empty() ? 0 : 1;
    return publisher_ ? publisher_.getNumSubscribers() : 0;
  }

 private:
  ros::Publisher publisher_;
  BagTarget* target_ = nullptr;
  std::string topic_;
};

/// Makes sinks, in the graph or into a bag.
class SinkSource {
 public:
  SinkSource(const ros::NodeHandle& handle) : handle_(handle) {}  // NOLINT: a handle is enough
  /// @param target  lives as long as the sinks
  SinkSource(BagTarget& target) : target_(&target) {}  // NOLINT: so is a bag

  bool isGraph() const { return target_ == nullptr; }

  /// @param on_connect  called from the thread of ROS when somebody begins to listen; never for a bag
  template <class M>
  MessageSink advertise(const std::string& topic, std::uint32_t queue, bool latch = false,
                        const std::function<void()>& on_connect = {}) {
    if (target_ != nullptr) {
      const std::string whole = topic[0] == '/' ? topic : target_->prefix + topic;
      return MessageSink(*target_, target_->wanted(whole) ? whole : "");
    }
    ros::SubscriberStatusCallback connected;
    if (on_connect) connected = [on_connect](const ros::SingleSubscriberPublisher&) { on_connect(); };
    return MessageSink(
        handle_->advertise<M>(topic, queue, connected, ros::SubscriberStatusCallback(), ros::VoidConstPtr(), latch));
  }

 private:
  std::optional<ros::NodeHandle> handle_;
  BagTarget* target_ = nullptr;
};

}  // namespace vibe::sim
