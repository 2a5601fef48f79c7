#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include <ros/callback_queue.h>
#include <ros/master.h>
#include <ros/node_handle.h>
#include <rosbag/bag.h>
#include <topic_tools/shape_shifter.h>

namespace vibe::sim {

/// How much of the graph is recorded.
enum class RecordingDepth {
  Replayable,  ///< what a replay computes again is thinned or left out, see recordingRules(); compressed
  Everything   ///< every message of every topic, not compressed
};

/// Records the topics of the graph to a bag and loses nothing. `rosbag record` holds at most 100 messages per topic
/// and drops the oldest when it gets no processor time for that long; here nothing is dropped, and what the disk cannot
/// take at once waits in memory. The file grows by chunks of 2 s, or of 256 kB before compression if that is less: if
/// the recorder is killed or the disk is full, the last one is lost. Not thread-safe: call everything from one thread.
class Recorder {
 public:
  /// @param file        the bag, claimed with claimBag(); until close() it is called `file`.active
  /// @param last_topic  subscribed to only when every other topic is connected, so that a publisher that waits for a
  ///                    listener of this topic can rely on the recording of all; after 10 s it is subscribed to with a
  ///                    warning, since publishers that were killed stay registered; empty: none
  /// @throws Error if the file cannot be written
  Recorder(const std::string& file, const std::string& last_topic, RecordingDepth depth);
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
  std::size_t topicCount() const;                         ///< recorded, thinned ones included
  std::uint64_t size() const { return bag_->getSize(); }  ///< of the file so far [bytes]

 private:
  using Event = ros::MessageEvent<topic_tools::ShapeShifter const>;

  /// A topic of which not every message is kept.
  struct Thinning {
    double period = 0;  // [s]
    ros::Time last{ros::TIME_MIN};
    std::optional<int> stamp_place;  // in its messages; known with the first
    std::optional<Event> left_out;   // the last message, if it has not been written; kept when the recording ends
  };

  void subscribe(const ros::master::TopicInfo& topic);
  void receive(const std::string& topic, const Event& event);
  void write(const std::string& topic, const Event& event);
  bool isChunkDue();
  bool areConnected(const ros::master::V_TopicInfo& published) const;
  bool isPatienceOver(const ros::master::V_TopicInfo& published);
  void drain();

  ros::NodeHandle handle_;
  ros::CallbackQueue queue_;
  std::map<std::string, ros::Subscriber> subscribers_;  // by topic; invalid where a topic is not recorded
  std::map<std::string, Thinning> thinned_;
  std::vector<std::uint8_t> bytes_;  // of a message whose stamp is looked for
  RecordingDepth depth_;
  std::unique_ptr<rosbag::Bag> bag_ = std::make_unique<rosbag::Bag>();
  std::string file_;
  std::string last_topic_;
  std::set<std::string> simulators_;  // their namespaces, with a slash at the end
  ros::SteadyTime last_topic_found_;  // zero: not yet
  std::string write_error_;           // of a callback, where an exception would be lost
  std::uint64_t message_count_ = 0;
  ros::SteadyTime last_chunk_ = ros::SteadyTime::now();
};

}  // namespace vibe::sim
