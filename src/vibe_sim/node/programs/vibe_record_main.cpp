#include <csignal>
#include <cstdio>
#include <string>
#include <vector>

#include <ros/ros.h>

#include "recording/bag_name.hpp"
#include "recording/recorder.hpp"
#include "vibe_core/program/error.hpp"
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
  bool free_name = false;
  vibe::sim::RecordingDepth depth = vibe::sim::RecordingDepth::Replayable;
};

/// @throws Error
Options readOptions(const std::vector<std::string>& words) {
  Options options;
  for (std::size_t i = 1; i < words.size(); ++i) {
    if (words[i] == "--last" && i + 1 < words.size()) {
      options.last_topic = words[++i];
    } else if (words[i] == "--free-name") {
      options.free_name = true;
    } else if (words[i] == "--all") {
      options.depth = vibe::sim::RecordingDepth::Everything;
    } else if (words[i].rfind('-', 0) != 0 && options.file.empty()) {
      options.file = words[i];
    } else {
      throw vibe::Error("Argument '" + words[i] +
                        "' is not understood; call it as: vibe_record [--all] [--free-name] [--last TOPIC] FILE");
    }
  }
  if (options.file.empty())
    throw vibe::Error("No file is given; call it as: vibe_record [--all] [--free-name] [--last TOPIC] FILE");
  return options;
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

}  // namespace

int main(int argc, char** argv) {
  std::signal(SIGXFSZ, SIG_IGN);  // a limit on the size of files is then an error like a full disk
  bool running = false;
  try {
    vibe::ros_utils::initWithGoodbye(argc, argv, "vibe_record", ros::init_options::AnonymousName);
    if (vibe::ros_utils::asksForHelp(argc, argv)) {
      std::puts(
          "vibe_record: records the graph to a bag until Ctrl-C: inputs, events and all that a replay cannot compute\n"
          "again; of the rest enough to look at it.\n"
          "Usage: rosrun vibe_sim vibe_record [--all] [--free-name] [--last TOPIC] FILE\n"
          "  --all         every message of every topic, some 7 MB per second\n"
          "  --free-name   where FILE is there already, FILE-2, FILE-3 and so on\n"
          "  --last TOPIC  is subscribed to when all other topics are connected (default: applied_input)");
      return 0;
    }
    const Options options = readOptions({argv, argv + argc});
    if (!vibe::ros_utils::waitForMaster(kMasterPatience)) return kFailure;
    std::string file = options.file;
    if (options.free_name) {
      file = vibe::sim::claimFreeBag(file);
    } else {
      vibe::sim::claimBag(file);
    }
    vibe::sim::Recorder recorder(file, options.last_topic, options.depth);
    running = true;
    recordUntilStopped(recorder);
    recorder.close();
    std::printf("%llu messages on %zu topics recorded to %s\n",
                static_cast<unsigned long long>(recorder.messageCount()), recorder.topicCount(), file.c_str());
    ros::shutdown();
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "vibe_record: %s\n", error.what());
    return running ? kFailure : kUsage;
  }
}
