#pragma once
#include <ros/callback_queue.h>
#include <ros/master.h>
#include <ros/node_handle.h>
#include <rosbag/bag.h>
#include <topic_tools/shape_shifter.h>

#include <cstdint>
#include <map>
#include <memory>
#include <string>

namespace vibe {

/// Records every topic of the graph to a bag and loses nothing. `rosbag record` holds at most 100 messages per topic
/// and drops the oldest when it gets no processor time for that long; here nothing is dropped, and what the disk cannot
/// take at once waits in memory. Not thread-safe: call everything from one thread.
class Recorder {
 public:
  /// @param file        the bag; until close() it is called `file`.active
  /// @param last_topic  subscribed to only when every other topic is connected, so that a publisher that waits for a
  ///                    listener of this topic can rely on the recording of all; empty: none
  /// @throws Error if the file cannot be written
  Recorder(const std::string& file, const std::string& last_topic);
  ~Recorder();

  /// Subscribes to topics that have appeared since the last call.
  /// @return false if the master does not answer
  bool findTopics();

  /// Writes what arrives within this time [s of wall time].
  /// @throws Error if the file cannot be written
  void record(double duration);

  /// Writes what has arrived, ends the file and gives it its name.
  /// @throws Error if the file cannot be written
  void close();

  std::uint64_t messageCount() const { return message_count_; }
  std::size_t topicCount() const { return subscribers_.size(); }

 private:
  using Event = ros::MessageEvent<topic_tools::ShapeShifter const>;

  void subscribe(const std::string& topic);
  void write(const std::string& topic, const Event& event);
  bool areConnected(const ros::master::V_TopicInfo& published) const;
  void drain();

  ros::NodeHandle handle_;
  ros::CallbackQueue queue_;
  std::map<std::string, ros::Subscriber> subscribers_;
  std::unique_ptr<rosbag::Bag> bag_ = std::make_unique<rosbag::Bag>();
  std::string file_;
  std::string last_topic_;
  std::string write_error_;  // of a callback, where an exception would be lost
  std::uint64_t message_count_ = 0;
};

}  // namespace vibe
