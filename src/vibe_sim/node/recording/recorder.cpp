#include "recording/recorder.hpp"

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstring>
#include <sstream>
#include <vector>

#include <ros/master.h>

#include "recording/bag_name.hpp"
#include "recording/recording.hpp"
#include "vibe_core/program/error.hpp"

namespace vibe::sim {

namespace {

constexpr std::uint32_t kUnlimited = 0;
constexpr double kPublisherTimeout = 10;      // with publishers that are registered and do not answer [s of wall time]
constexpr std::uint32_t kChunk = 256 * 1024;  // written at once [bytes]
constexpr double kChunkPeriod = 2;            // after which a chunk is written though it is not full [s of wall time]
constexpr double kEarly = 0.99;   // of the period of a topic that is thinned, after which a message counts as due
constexpr double kQuiet = 0.2;    // without a message everything that was sent has arrived [s]
constexpr int kDrainRounds = 20;  // of kQuiet at most, for a graph that goes on sending

// Where the stamp of a message of this type is; -1 if it has none in its first field.
int stampPlace(const topic_tools::ShapeShifter& message) {
  if (message.getDataType() == "rosgraph_msgs/Clock") return 0;
  std::istringstream lines(message.getMessageDefinition());
  for (std::string type, name, rest; lines >> type; std::getline(lines, rest)) {
    if (type[0] == '#') continue;
    lines >> name;
    const bool is_header = (type == "Header" || type == "std_msgs/Header") && name == "header";
    return is_header ? static_cast<int>(sizeof(std::uint32_t)) : -1;  // behind the number
  }
  return -1;
}

// By its own stamp, since messages may arrive in bursts.
// @param bytes  buffer, as large as the largest message so far
ros::Time timeOf(const topic_tools::ShapeShifter& message, int place, std::vector<std::uint8_t>& bytes) {
  if (place < 0 || message.size() < static_cast<std::size_t>(place) + sizeof(std::uint64_t)) return ros::Time::now();
  if (bytes.size() < message.size()) bytes.resize(message.size());
  ros::serialization::OStream out(bytes.data(), message.size());
  message.write(out);
  std::array<std::uint32_t, 2> stamp{};  // seconds, nanoseconds
  std::memcpy(&stamp, bytes.data() + place, sizeof stamp);
  return {stamp[0], stamp[1]};
}

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

Recorder::Recorder(const std::string& file, const std::string& last_topic, RecordingDepth depth)
    : depth_(depth), file_(file), last_topic_(last_topic) {
  handle_.setCallbackQueue(&queue_);
  if (!last_topic_.empty()) {
    last_topic_ = handle_.resolveName(last_topic_);
    simulators_.insert(last_topic_.substr(0, last_topic_.rfind('/') + 1));
  }
  try {
    bag_->open(file_ + ".active", rosbag::bagmode::Write);
    bag_->setChunkThreshold(kChunk);
    if (depth_ == RecordingDepth::Replayable) bag_->setCompression(rosbag::compression::BZ2);
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
  for (const ros::master::TopicInfo& topic : topics)
    if (topic.datatype == "vibe_msgs/StepInput" && isTopic(topic.name, "applied_input"))
      simulators_.insert(topic.name.substr(0, topic.name.rfind('/') + 1));
  const ros::master::TopicInfo* last = nullptr;
  for (const ros::master::TopicInfo& topic : topics) {
    if (subscribers_.count(topic.name) > 0) continue;
    if (topic.name == last_topic_) {
      last = &topic;
    } else {
      subscribe(topic);
    }
  }
  if (last != nullptr && (areConnected(topics) || isPatienceOver(topics))) subscribe(*last);
  return true;
}

std::size_t Recorder::topicCount() const {
  const auto is_recorded = [](const auto& entry) { return static_cast<bool>(entry.second); };
  return static_cast<std::size_t>(std::count_if(subscribers_.begin(), subscribers_.end(), is_recorded));
}

void Recorder::subscribe(const ros::master::TopicInfo& topic) {
  const RecordingRule* rule =
      depth_ == RecordingDepth::Everything ? nullptr : recordingRule(topic.name, topic.datatype, simulators_);
  ros::Subscriber& subscriber = subscribers_[topic.name];
  if (rule != nullptr && rule->period == kNever) return;
  if (rule != nullptr) thinned_[topic.name].period = rule->period;
  ros::SubscribeOptions options;
  options.topic = topic.name;
  options.queue_size = kUnlimited;
  options.md5sum = ros::message_traits::md5sum<topic_tools::ShapeShifter>();
  options.datatype = ros::message_traits::datatype<topic_tools::ShapeShifter>();
  options.helper = boost::make_shared<ros::SubscriptionCallbackHelperT<const Event&>>(
      [this, name = topic.name](const Event& event) { receive(name, event); });
  subscriber = handle_.subscribe(options);
}

// Of what is published now: a topic whose only publisher has gone again is nothing to wait for.
bool Recorder::areConnected(const ros::master::V_TopicInfo& published) const {
  return std::all_of(published.begin(), published.end(), [this](const ros::master::TopicInfo& topic) {
    const auto entry = subscribers_.find(topic.name);
    return entry == subscribers_.end() || !entry->second || entry->second.getNumPublishers() > 0;
  });
}

bool Recorder::isPatienceOver(const ros::master::V_TopicInfo& published) {
  const ros::SteadyTime now = ros::SteadyTime::now();
  if (last_topic_found_.isZero()) last_topic_found_ = now;
  if ((now - last_topic_found_).toSec() < kPublisherTimeout) return false;
  std::string silent;
  for (const ros::master::TopicInfo& topic : published) {
    const auto entry = subscribers_.find(topic.name);
    if (entry != subscribers_.end() && entry->second && entry->second.getNumPublishers() == 0)
      silent += (silent.empty() ? "" : ", ") + topic.name;
  }
  std::fprintf(stderr,
               "vibe_record: nobody answers who is registered as publisher of %s; if its node was killed, `rosnode "
               "cleanup` removes it.\n",
               silent.c_str());
  return true;
}

void Recorder::receive(const std::string& topic, const Event& event) {
  const auto thinned = thinned_.find(topic);
  if (thinned == thinned_.end()) return write(topic, event);
  Thinning& thinning = thinned->second;
  if (!thinning.stamp_place) thinning.stamp_place = stampPlace(*event.getMessage());
  const ros::Time now = timeOf(*event.getMessage(), *thinning.stamp_place, bytes_);
  const double since = (now - thinning.last).toSec();
  if (thinning.last != ros::TIME_MIN && since >= 0 && since < kEarly * thinning.period) {
    thinning.left_out.emplace(event);
    return;
  }
  thinning.last = now;
  thinning.left_out.reset();
  write(topic, event);
}

void Recorder::write(const std::string& topic, const Event& event) {
  ++message_count_;
  if (!write_error_.empty()) return;
  const bool due = isChunkDue();
  try {
    if (due) bag_->setChunkThreshold(0);  // ends the chunk, and the next one with this message
    // before the first /clock it is time 0, which a bag refuses
    bag_->write(topic, std::max(event.getReceiptTime(), ros::TIME_MIN), *event.getMessage(),
                event.getConnectionHeaderPtr());
    if (due) bag_->setChunkThreshold(kChunk);
  } catch (const rosbag::BagException& error) {
    write_error_ = "Recording '" + file_ + "' breaks off (" + error.what() + "); make room on the disk.";
  }
}

bool Recorder::isChunkDue() {
  const ros::SteadyTime now = ros::SteadyTime::now();
  if ((now - last_chunk_).toSec() < kChunkPeriod) return false;
  last_chunk_ = now;
  return true;
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
  for (auto& [topic, thinning] : thinned_)
    if (thinning.left_out) write(topic, *thinning.left_out);
  if (write_error_.empty()) {
    try {
      bag_->close();
    } catch (const rosbag::BagException& error) {
      write_error_ = "Recording '" + file_ + "' cannot be ended (" + error.what() + "); make room on the disk.";
    }
  }
  if (!write_error_.empty()) throw Error(write_error_);
  finishBag(file_);
}

}  // namespace vibe::sim
