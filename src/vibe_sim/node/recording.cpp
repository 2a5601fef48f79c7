#include "recording.hpp"

#include <rosbag/bag.h>
#include <rosbag/view.h>
#include <std_msgs/String.h>
#include <vibe_msgs/SolverStatistics.h>
#include <vibe_msgs/StepInput.h>

#include "step_input_reader.hpp"
#include "vibe_core/common/error.hpp"

namespace vibe {
namespace {

bool endsWith(const std::string& topic, const std::string& name) {
  return topic == name || (topic.size() > name.size() &&
                           topic.compare(topic.size() - name.size() - 1, std::string::npos, "/" + name) == 0);
}

class RecordingReader {
 public:
  explicit RecordingReader(const std::string& file) : file_(file) {}

  void read(const rosbag::MessageInstance& message) {
    if (message.getDataType() == ros::message_traits::datatype<vibe_msgs::StepInput>()) {
      addInput(readInput(message));
    } else if (const auto statistics = message.instantiate<vibe_msgs::SolverStatistics>()) {
      result.hashes[statistics->steps] = statistics->state_hash;
    } else if (endsWith(message.getTopic(), "scene") && result.scene.empty()) {
      if (const auto scene = message.instantiate<std_msgs::String>()) result.scene = scene->data;
    }
  }

  Recording result;

 private:
  RecordedStep readInput(const rosbag::MessageInstance& message) {
    std::vector<std::uint8_t> bytes(message.size());
    ros::serialization::OStream out(bytes.data(), static_cast<std::uint32_t>(bytes.size()));
    message.write(out);
    try {
      const auto reader = readers_.try_emplace(message.getMD5Sum(), message.getMessageDefinition()).first;
      return reader->second.read(bytes.data(), bytes.size());
    } catch (const Error& error) {
      throw Error("Recording '" + file_ + "' cannot be replayed: " + error.what());
    }
  }

  void addInput(const RecordedStep& recorded) {
    if (recorded.step != result.inputs.size())
      throw Error(
          "Recording '" + file_ + "' has step " + std::to_string(recorded.step) + " where step " +
          std::to_string(result.inputs.size()) +
          " was due: it began late, lost messages, or the session was reset; record from the start without resets.");
    result.inputs.push_back(recorded.input);
    result.comparable = result.comparable && recorded.has_version;
  }

  std::string file_;
  std::map<std::string, StepInputReader> readers_;  // by md5 sum of the definition
};

}  // namespace

Recording readRecording(const std::string& file) {
  RecordingReader reader(file);
  try {
    rosbag::Bag bag(file, rosbag::bagmode::Read);
    for (const rosbag::MessageInstance& message : rosbag::View(bag)) reader.read(message);
  } catch (const rosbag::BagException& error) {
    throw Error("Recording '" + file + "' cannot be read: " + error.what() + "; try 'rosbag reindex' on a copy.");
  }
  if (reader.result.scene.empty())
    throw Error("Recording '" + file + "' has no topic scene; record all topics, from before the simulator's start.");
  if (reader.result.inputs.empty())
    throw Error("Recording '" + file + "' has no topic applied_input; record all topics of the simulator.");
  return std::move(reader.result);
}

}  // namespace vibe
