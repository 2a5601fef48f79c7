#include <cstdio>
#include <string>

#include <ros/ros.h>

#include "recording/bag_name.hpp"
#include "recording/recorder.hpp"
#include "vibe_core/program/command_line.hpp"
#include "vibe_ros_utils/startup.hpp"

// vibe_record: records the topics of the graph to a bag, without losing a message, until SIGINT.

namespace {

constexpr int kFailure = 1;
constexpr int kUsage = 2;
constexpr double kSearchPeriod = 0.2;  // between looks for new topics [s]
constexpr double kMasterPatience =
    10;  // without an answer of the master, at the start or before the recording ends [s]

struct Options {
  std::string file;
  std::string last_topic = "applied_input";
  bool free_name = false, all = false;
};

void addOptions(vibe::OptionList& line, Options& o) {
  line.option("FILE", o.file, "bag to write").typeName("").required();
  line.flag("--all", o.all, "every message of every topic, some 7 MB per second");
  line.flag("--free-name", o.free_name, "where FILE is there already, FILE-2, FILE-3 and so on");
  line.option("--last", o.last_topic, "is subscribed to when all other topics are connected (default: applied_input)")
      .typeName("TOPIC");
}

/// @throws Error
void recordUntilStopped(vibe::sim::Recorder& recorder) {
  double silence = 0;
  while (vibe::ros_utils::stopSignal() == 0 && ros::ok()) {
    const bool answers = recorder.findTopics();
    if (answers && silence > 0) {
      std::fprintf(stderr,
                   "vibe_record: a ROS master answers again; if it is a new one, start another recording: nodes that "
                   "start from now on are not in this one.\n");
    }
    silence = answers ? 0 : silence + kSearchPeriod;
    if (silence > kMasterPatience) {
      std::fprintf(stderr, "vibe_record: the ROS master at %s does not answer; the recording ends.\n",
                   ros::master::getURI().c_str());
      return;
    }
    recorder.record(kSearchPeriod);
  }
}

int run(const Options& options) {
  if (!vibe::ros_utils::waitForMaster(kMasterPatience)) return kFailure;
  std::string file = options.file;
  if (options.free_name) {
    file = vibe::sim::claimFreeBag(file);
  } else {
    vibe::sim::claimBag(file);
  }
  using Depth = vibe::sim::RecordingDepth;
  vibe::sim::Recorder recorder(file, options.last_topic, options.all ? Depth::Everything : Depth::Replayable);
  try {
    recordUntilStopped(recorder);
    recorder.close();
  } catch (const std::exception& error) {
    std::fprintf(stderr, "vibe_record: %s\n", error.what());
    return kFailure;
  }
  std::printf("%llu messages on %zu topics recorded to %s\n", static_cast<unsigned long long>(recorder.messageCount()),
              recorder.topicCount(), file.c_str());
  ros::shutdown();
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  vibe::CommandLine line(
      "Records the graph to a bag until Ctrl-C: inputs, events and all that a replay cannot compute again; of the "
      "rest\n"
      "enough to look at it.",
      "vibe_record");
  addOptions(line, options);
  try {
    vibe::ros_utils::initWithGoodbye(argc, argv, "vibe_record", ros::init_options::AnonymousName);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "vibe_record: %s\n", error.what());
    return kUsage;
  }
  return vibe::runProgram(line, argc, argv, [&] { return run(options); });
}
