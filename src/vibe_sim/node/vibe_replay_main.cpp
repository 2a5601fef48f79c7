// Steps the simulator through the inputs of a recording, without a roscore, and compares the hash with the recorded
// one.
#include <rosbag/bag.h>
#include <rosbag/view.h>
#include <std_msgs/String.h>
#include <vibe_msgs/SolverStatistics.h>
#include <vibe_msgs/StepInput.h>

#include <cstdio>
#include <map>
#include <string>
#include <vector>

#include "conversions.hpp"
#include "vibe_core/common/error.hpp"
#include "vibe_core/common/package_path.hpp"
#include "vibe_core/metrics/run_summary.hpp"
#include "vibe_core/scene/scene_parser.hpp"
#include "vibe_core/simulation/simulator.hpp"

namespace {

using namespace vibe;

const char kHelp[] =
    "usage: vibe_replay BAG\n"
    "Repeats a recorded session from its topics scene and applied_input, without a roscore, and prints the state "
    "hash.\n"
    "Ends with 0 if the recording's own hash is the same, with 1 if it is not, with 2 if it cannot be repeated.\n";

/// What of a recording is needed to repeat it.
struct Recording {
  std::string scene;
  std::vector<StepInput> inputs;                ///< of steps 0, 1, 2 ...
  std::map<std::uint64_t, std::string> hashes;  ///< by number of steps taken
};

bool endsWith(const std::string& topic, const std::string& name) {
  return topic == name || (topic.size() > name.size() &&
                           topic.compare(topic.size() - name.size() - 1, std::string::npos, "/" + name) == 0);
}

// Recordings from before there was a hand that pulls lack the two last fields; the others are where they were.
constexpr const char* kInputWithoutPull = "1f585b34d516cf0e67cc5d0690fb16bb";

boost::shared_ptr<vibe_msgs::StepInput> readInput(const rosbag::MessageInstance& message, const std::string& file) {
  if (message.getDataType() != ros::message_traits::datatype<vibe_msgs::StepInput>()) return nullptr;
  if (auto input = message.instantiate<vibe_msgs::StepInput>()) return input;
  if (message.getMD5Sum() != kInputWithoutPull)
    throw Error("Recording '" + file + "' has another kind of vibe_msgs/StepInput (md5 sum " + message.getMD5Sum() +
                "); repeat it with the version that recorded it.");
  auto input = boost::make_shared<vibe_msgs::StepInput>();
  input->pull_particle = -1;
  const std::uint32_t lacking = ros::serialization::serializationLength(input->pull_particle) +
                                ros::serialization::serializationLength(input->pull_target);
  std::vector<std::uint8_t> bytes(message.size() + lacking, 0);
  ros::serialization::OStream out(bytes.data(), message.size());
  message.write(out);
  ros::serialization::OStream end(bytes.data() + message.size(), lacking);
  ros::serialization::serialize(end, input->pull_particle);
  ros::serialization::IStream in(bytes.data(), static_cast<std::uint32_t>(bytes.size()));
  ros::serialization::deserialize(in, *input);
  return input;
}

void readMessage(const rosbag::MessageInstance& message, const std::string& file, Recording& recording) {
  if (const auto input = readInput(message, file)) {
    if (input->step != recording.inputs.size())
      throw Error(
          "Recording '" + file + "' has step " + std::to_string(input->step) + " where step " +
          std::to_string(recording.inputs.size()) +
          " was due: it began late, lost messages, or the session was reset; record from the start without resets.");
    recording.inputs.push_back(readStepInput(*input));
  } else if (const auto statistics = message.instantiate<vibe_msgs::SolverStatistics>()) {
    recording.hashes[statistics->steps] = statistics->state_hash;
  } else if (endsWith(message.getTopic(), "scene") && recording.scene.empty()) {
    if (const auto scene = message.instantiate<std_msgs::String>()) recording.scene = scene->data;
  }
}

Recording readRecording(const std::string& file) {
  Recording recording;
  try {
    rosbag::Bag bag(file, rosbag::bagmode::Read);
    for (const rosbag::MessageInstance& message : rosbag::View(bag)) readMessage(message, file, recording);
  } catch (const rosbag::BagException& error) {
    throw Error("Recording '" + file + "' cannot be read: " + error.what() + "; try 'rosbag reindex' on a copy.");
  }
  if (recording.scene.empty())
    throw Error("Recording '" + file + "' has no topic scene; record all topics, from before the simulator's start.");
  if (recording.inputs.empty())
    throw Error("Recording '" + file + "' has no topic applied_input; record all topics of the simulator.");
  return recording;
}

/// @return 0 if the hash is the recorded one or none was recorded for the last step
int compare(const Recording& recording, const std::string& result) {
  const auto recorded = recording.hashes.find(recording.inputs.size());
  if (recorded == recording.hashes.end()) {
    std::printf("the recording has no hash for its last step to compare with\n");
    return 0;
  }
  const bool same = recorded->second == result;
  std::printf("recorded hash: %s, %s\n", recorded->second.c_str(), same ? "the same" : "NOT the same");
  return same ? 0 : 1;
}

int replay(const std::string& file) {
  const Recording recording = readRecording(file);
  const Scene scene = parseScene(recording.scene, file + " (topic scene)");
  const std::string urdf = scene.scope ? readTextFile(resolveAddress(scene.scope->urdf), "URDF") : "";
  const std::shared_ptr<const Model> model = buildModel(scene, urdf);
  State state = initialState(*model, scene.seed);
  Workspace workspace(*model);
  std::vector<Event> events;
  for (const StepInput& input : recording.inputs) {
    events.clear();
    step(*model, state, input, workspace, events);
    if (state.step % 600 == 0) {
      std::printf("\rrepeated %.0f of %.0f s", state.time,
                  static_cast<double>(recording.inputs.size()) * scene.step_period);
      std::fflush(stdout);
    }
  }
  const std::string result = toHex(hash(state));
  std::printf("\rrepeated %zu steps, %.2f s      \nstate hash: %s\n", recording.inputs.size(), state.time,
              result.c_str());
  return compare(recording, result);
}

}  // namespace

int main(int argc, char** argv) {
  const std::string argument = argc == 2 ? argv[1] : "";
  if (argument == "--help") {
    std::fputs(kHelp, stdout);
    return 0;
  }
  if (argument.empty() || argument[0] == '-') {
    std::fputs("vibe_replay: takes one recording; see --help.\n", stderr);
    return 2;
  }
  try {
    return replay(argument);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "vibe_replay: %s\n", error.what());
    return 2;
  }
}
