#include "recording/recording.hpp"

#include <algorithm>
#include <filesystem>

#include <rosbag/view.h>
#include <std_msgs/String.h>
#include <vibe_msgs/SolverStatistics.h>
#include <vibe_msgs/StateSnapshot.h>
#include <vibe_msgs/StepInput.h>

#include "conversions/conversions.hpp"
#include "vibe_core/common/error.hpp"

namespace vibe::sim {

namespace {

template <class M>
bool is(const rosbag::MessageInstance& message) {
  return message.getDataType() == ros::message_traits::datatype<M>();
}

std::unique_ptr<rosbag::Bag> open(const std::string& file) {
  std::error_code code;
  const auto size = std::filesystem::file_size(file, code);
  if (code) throw Error("Recording '" + file + "' cannot be read (" + code.message() + "); check the path.");
  if (size == 0) throw Error("Recording '" + file + "' is empty: nothing was recorded.");
  try {
    return std::make_unique<rosbag::Bag>(file, rosbag::bagmode::Read);
  } catch (const rosbag::BagUnindexedException&) {
    throw Error("Recording '" + file + "' was cut off: the recorder was killed or the disk was full; mend it with " +
                "`rosbag reindex '" + file + "'`, which keeps all but the last chunk.");
  } catch (const std::exception& error) {  // of a damaged file also what is not a BagException
    throw Error("Recording '" + file + "' cannot be read as a bag (" + error.what() +
                "); if it was damaged, try `rosbag reindex` on a copy.");
  }
}

}  // namespace

Recording::Recording(const std::string& file) : file_(file), bag_(open(file)) {
  try {
    readAll();
  } catch (const Error&) {
    throw;
  } catch (const std::exception& error) {
    throw Error("Recording '" + file_ + "' is damaged (" + error.what() + "); try `rosbag reindex` on a copy.");
  }
  check();
}

void Recording::readAll() {
  const auto wanted = [](const rosbag::ConnectionInfo* connection) {
    for (const char* name : {"scene", "session_info", "snapshot", "applied_input", "solver_statistics"})
      if (isTopic(connection->topic, name)) return true;
    return false;
  };
  for (const rosbag::MessageInstance& message : rosbag::View(*bag_, wanted)) readMessage(message);
}

void Recording::readMessage(const rosbag::MessageInstance& message) {
  if (is<vibe_msgs::StepInput>(message)) {
    const std::string topic = message.getTopic();
    prefix_ = topic.substr(0, topic.size() - std::string("applied_input").size());
    const RecordedStep step = readStep(message);
    runOf(step.run).steps.push_back(step);
  } else if (const auto snapshot = message.instantiate<vibe_msgs::StateSnapshot>()) {
    runOf(snapshot->run).snapshots.emplace(snapshot->step, message.getTime());
  } else if (const auto info = message.instantiate<vibe_msgs::SessionInfo>()) {
    runOf(info->run).info = *info;
  } else if (const auto statistics = message.instantiate<vibe_msgs::SolverStatistics>()) {
    state_hashes_.emplace(fromRosTime(statistics->header.stamp), statistics->state_hash);
  } else if (const auto scene = message.instantiate<std_msgs::String>()) {
    if (isTopic(message.getTopic(), "scene")) scenes_.emplace_back(message.getTime(), scene->data);
  }
}

RecordedStep Recording::readStep(const rosbag::MessageInstance& message) {
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

RecordedRun& Recording::runOf(std::uint32_t number) {
  RecordedRun& run = by_number_[number];
  run.number = number;
  return run;
}

// A bag is read in the order of its times, and these go back where a reset sets the clock back.
void Recording::sortSteps(RecordedRun& run) const {
  std::stable_sort(run.steps.begin(), run.steps.end(),
                   [](const RecordedStep& a, const RecordedStep& b) { return a.step < b.step; });
  std::uint64_t due = run.steps.front().has_hashes ? run.steps.front().step : 0;
  for (const RecordedStep& step : run.steps) {
    if (step.step != due)
      throw Error("Recording '" + file_ + "' has step " + std::to_string(step.step) + " where step " +
                  std::to_string(due) + " was due: messages of applied_input are missing, were edited, or (in older " +
                  "releases) it began late or the session was reset; record it again.");
    ++due;
  }
}

// A run can be repeated from its first snapshot. Of the first one steps before it may be missing: it began late.
void Recording::takeRun(RecordedRun& run) {
  sortSteps(run);
  const auto start = std::find_if(run.steps.begin(), run.steps.end(), [&run](const RecordedStep& step) {
    return run.snapshots.count(step.step) > 0 || (step.step == 0 && run.number <= 1);
  });
  const auto before = static_cast<std::size_t>(start - run.steps.begin());
  if (runs_.empty()) {
    left_out_ += before;
  } else if (before > 0 && lost_.empty()) {
    lost_ = std::to_string(before) + " steps of run " + std::to_string(run.number) +
            " come before its first snapshot, which the recording lacks";
  }
  run.steps.erase(run.steps.begin(), start);
  if (!run.steps.empty()) runs_.push_back(std::move(run));
}

void Recording::check() {
  if (by_number_.empty())
    throw Error("Recording '" + file_ +
                "' has no topic applied_input with inputs: it is not of this simulator, or was " +
                "made without it; record with scripts/record.");
  std::uint32_t due = by_number_.begin()->first;
  for (auto& [number, run] : by_number_) {
    if (number != due && lost_.empty()) lost_ = "the recording lacks run " + std::to_string(due);
    due = number + 1;
    if (run.steps.empty()) continue;
    if (run.info) run.scene = run.info->scene;
    if (run.scene.empty() && !scenes_.empty()) run.scene = scenes_.front().second;
    if (run.scene.empty())
      throw Error("Recording '" + file_ + "' has no topic scene; record all topics of the simulator.");
    takeRun(run);
  }
  by_number_.clear();
  if (runs_.empty())
    throw Error("Recording '" + file_ + "' has no step that a replay can begin from: it began late and ended before " +
                "the first snapshot, which comes at most 10 s later; record for longer.");
}

std::string Recording::snapshot(const RecordedRun& run, std::uint64_t step) const {
  const ros::Time time = run.snapshots.at(step);
  rosbag::View view(*bag_, rosbag::TopicQuery(prefix_ + "snapshot"), time, time);
  for (const rosbag::MessageInstance& message : view) {
    const auto snapshot = message.instantiate<vibe_msgs::StateSnapshot>();
    if (snapshot && snapshot->run == run.number && snapshot->step == step)
      return {snapshot->data.begin(), snapshot->data.end()};
  }
  throw Error("Recording '" + file_ + "' is damaged: its snapshot of step " + std::to_string(step) +
              " cannot be read.");
}

// The periods keep enough to look at a session with rosbag play and to plot it without a replay.
const std::vector<RecordingRule>& recordingRules() {
  static const std::vector<RecordingRule> rules = {
      {"tissue/particles", 2, true},
      {"sutures", 2, true},
      {"tissue/pull_state", 0.1, true},
      {"scope/measured_cp", 0.1, true},
      {"scope/measured_cf", 0.1, true},
      {"joint_states", 0.1, true},
      {"overstitch/helix/measured_cp", kNever, true},
      {"scope/setpoint_js", kNever, true},
      {"scope/simulated/measured_js", kNever, true},
      {"overstitch/simulated/measured_js", kNever, true},
      {"scope/jacobian", kNever, true},
      {"wall/measured_cp", kNever, true},
      {"haptic/parameters", kNever, true},
      {"step_result", kNever, true},
      {"step_timing", kNever, true},
      {"/clock", 0.1, true},
      {"type:tf2_msgs/TFMessage", kNever, false},
      {"type:sensor_msgs/Image", kNever, false},
      {"type:sensor_msgs/CompressedImage", kNever, false},
      {"type:sensor_msgs/CameraInfo", kNever, false},
  };
  return rules;
}

bool isTopic(const std::string& topic, const std::string& name) {
  if (topic == name) return true;
  return topic.size() > name.size() && topic.compare(topic.size() - name.size(), name.size(), name) == 0 &&
         topic[topic.size() - name.size() - 1] == '/';
}

const RecordingRule* recordingRule(const std::string& topic, const std::string& type,
                                   const std::set<std::string>& prefixes) {
  // the frames of what stands still are sent once and are small
  if (isTopic(topic, "tf_static")) return nullptr;
  const auto& rules = recordingRules();
  const auto is_of_simulator = [&](const std::string& name) {
    return std::any_of(prefixes.begin(), prefixes.end(),
                       [&](const std::string& prefix) { return topic == prefix + name; });
  };
  const auto found = std::find_if(rules.begin(), rules.end(), [&](const RecordingRule& rule) {
    if (rule.topic.rfind("type:", 0) == 0) return rule.topic.substr(5) == type;
    return rule.topic[0] == '/' ? topic == rule.topic : is_of_simulator(rule.topic);
  });
  return found == rules.end() ? nullptr : &*found;
}

}  // namespace vibe::sim
