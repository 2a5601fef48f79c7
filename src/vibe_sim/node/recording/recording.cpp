#include "recording/recording.hpp"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <tuple>
#include <utility>

#include <rosbag/view.h>
#include <vibe_msgs/StateSnapshot.h>

#include "publishing/publishers.hpp"
#include "vibe_core/files/foreign_content.hpp"
#include "vibe_core/program/error.hpp"

namespace vibe::sim {

namespace {

// What is no bag of format 2.0 is told by its first bytes.
void checkBegin(const std::string& file) {
  std::ifstream stream(file, std::ios::binary);
  if (!stream) throw Error("Recording '" + file + "' cannot be opened; check its permissions.");
  std::string begin(1024, '\0');
  stream.read(begin.data(), static_cast<std::streamsize>(begin.size()));
  begin.resize(static_cast<std::size_t>(stream.gcount()));
  if (begin.rfind("#ROSBAG V2.0\n", 0) == 0) return;
  const std::string foreign = foreignContent(begin);
  if (!foreign.empty()) throw Error("Recording '" + file + "' " + foreign + ".");
  if (begin.rfind("#ROS", 0) == 0)
    throw Error("Recording '" + file + "' is a bag of another format than 2.0; convert a copy with `rosbag fix`.");
  throw Error("Recording '" + file +
              "' is not a bag: it does not begin with '#ROSBAG V2.0'; give the session.bag of a session.");
}

std::shared_ptr<rosbag::Bag> open(const std::string& file) {
  std::error_code code;
  const auto size = std::filesystem::file_size(file, code);
  if (code) throw Error("Recording '" + file + "' cannot be read (" + code.message() + "); check the path.");
  if (size == 0) throw Error("Recording '" + file + "' is empty: nothing was recorded.");
  checkBegin(file);
  try {
    return std::make_shared<rosbag::Bag>(file, rosbag::bagmode::Read);
  } catch (const rosbag::BagUnindexedException&) {
    throw Error("Recording '" + file + "' has no index, as a recorder leaves it that was killed or whose disk was " +
                "full; mend it with `rosbag reindex '" + file + "'`, which keeps all but the last chunk.");
  } catch (const std::exception& error) {  // of a damaged file also what is not a BagException
    throw Error("Recording '" + file + "' cannot be read to its end (" + error.what() +
                "); it may have been cut off: copy it again, or mend a copy with `rosbag reindex`.");
  }
}

std::pair<Bags, std::vector<RecordedSession>> openAll(const std::vector<std::string>& files) {
  Bags bags;
  for (const std::string& file : files) bags.push_back(open(file));
  try {
    auto sessions = readSessions(bags, files.front());
    return {std::move(bags), std::move(sessions)};
  } catch (const Error&) {
    throw;
  } catch (const std::exception& error) {
    throw Error("Recording '" + files.front() + "' is damaged (" + error.what() + "); try `rosbag reindex` on a copy.");
  }
}

// "/left/" of "left", "/left" or "/left/"; empty of nothing.
std::string withSlashes(std::string name) {
  if (name.empty()) return name;
  if (name.front() != '/') name = "/" + name;
  return name.back() == '/' ? name : name + "/";
}

// Whether these words are the number of a session in the list, or the beginning of its identity.
bool isMeant(const RecordedSession& session, std::size_t number, const std::string& words) {
  if (words.empty() || words == std::to_string(number)) return true;
  return words.size() >= 4 && session.idText().rfind(words, 0) == 0;
}

std::string nameOf(const RecordedSession& session) {
  const std::string id = session.id == 0 ? "without identity" : session.idText();
  return id + " in " + session.nameSpace();
}

std::string namesOf(const std::vector<RecordedSession>& sessions) {
  std::string all;
  for (std::size_t i = 0; i < sessions.size(); ++i)
    all += (i == 0 ? "" : ", ") + std::to_string(i + 1) + " (" + nameOf(sessions[i]) + ")";
  return all;
}

std::string countOf(std::size_t steps) {
  return std::to_string(steps) + (steps == 1 ? " step" : " steps");
}

std::string placeIn(const RecordedRun& run, std::uint64_t step) {
  return "step " + std::to_string(step) + " of run " + std::to_string(run.number);
}

// Up to three of these names.
std::string firstOf(const std::set<std::string>& names) {
  std::string all;
  std::size_t count = 0;
  for (const std::string& name : names) {
    if (++count > 3) return all + ", ...";
    all += (all.empty() ? "" : ", ") + name;
  }
  return all;
}

}  // namespace

Recording::Recording(const std::string& file, const SessionChoice& choice)
    : Recording(std::vector<std::string>{file}, choice) {}

Recording::Recording(const std::vector<std::string>& files, const SessionChoice& choice) : file_(files.front()) {
  std::tie(bags_, sessions_) = openAll(files);
  if (sessions_.empty()) refuseWithoutInputs();
  choose(choice);
  takeRuns();
}

std::vector<RecordedSession> listSessions(const std::vector<std::string>& files) {
  return openAll(files).second;
}

void Recording::refuse(const std::string& why) const {
  throw Error("Recording '" + file_ + "' " + why + "." + (is_chosen_ ? " " + remarkOnChoice() : ""));
}

void Recording::lose(const std::string& what) {
  lost_ += (lost_.empty() ? "" : "; ") + what;
}

void Recording::choose(const SessionChoice& choice) {
  const std::string wanted = withSlashes(choice.name_space);
  std::vector<std::size_t> fitting;
  for (std::size_t i = 0; i < sessions_.size(); ++i)
    if ((wanted.empty() || sessions_[i].prefix == wanted) && isMeant(sessions_[i], i + 1, choice.session))
      fitting.push_back(i);
  const auto asked = (choice.session.empty() ? "" : " '" + choice.session + "'") +
                     (wanted.empty() ? std::string() : " in the namespace '" + choice.name_space + "'");
  if (fitting.empty()) refuse("has no session" + asked + ", but " + namesOf(sessions_) + "; choose one of them");
  if (fitting.size() > 1 && !choice.session.empty())
    refuse("has several sessions" + asked + ": " + namesOf(sessions_) + "; choose one by its number");
  chosen_ = fitting.front();
  is_chosen_ = sessions_.size() > 1;
}

std::string Recording::remarkOnChoice() const {
  if (sessions_.size() < 2) return "";
  return "The recording holds " + std::to_string(sessions_.size()) + " sessions; this is number " +
         std::to_string(chosen_ + 1) + " (" + nameOf(session()) +
         "). --session and --namespace choose another, --list lists them.";
}

void Recording::takeRuns() {
  std::map<std::uint32_t, RecordedRun> by_number = std::move(sessions_[chosen_].runs);
  for (RecordedSession& each : sessions_) each.runs.clear();
  std::uint32_t due = by_number.begin()->first;
  std::size_t snapshots = 0;
  for (auto& [number, run] : by_number) {
    if (number != due) lose("the recording lacks run " + std::to_string(due));
    due = number + 1;
    snapshots += run.snapshots.size();
    if (run.steps.empty()) continue;
    run.scene = run.info ? run.info->scene : session().scene;
    if (run.scene.empty())
      refuse(
          "has neither the topic scene nor session_info, which say what was simulated and are sent when a session "
          "begins; if it was filtered, keep them, and if it is a part of a split recording, give the first part as "
          "well");
    takeRun(run);
  }
  if (runs_.empty()) refuseWithoutBegin(snapshots);
  if (gaps_.steps > 0)
    lose("applied_input lacks " + countOf(gaps_.steps) + " in " + std::to_string(gaps_.places) +
         (gaps_.places == 1 ? " place" : " places") + ", first after " + gaps_.first);
  if (unreachable_.steps > 0)
    lose("there is no snapshot from which " + countOf(unreachable_.steps) + " could be repeated, first " +
         unreachable_.first);
}

// A bag is read in the order of its times, and these go back where a reset sets the clock back.
void Recording::takeRun(RecordedRun& run) {
  std::stable_sort(run.steps.begin(), run.steps.end(),
                   [](const RecordedStep& a, const RecordedStep& b) { return a.step < b.step; });
  if (!run.steps.front().has_hashes && run.steps.front().step != 0)
    refuse("has step " + std::to_string(run.steps.front().step) +
           " where step 0 was due: it began late, and it has no snapshots from which a replay could begin");
  bool is_first = runs_.empty();
  for (auto begin = run.steps.begin(); begin != run.steps.end(); is_first = false) {
    auto end = begin + 1;
    while (end != run.steps.end() && end->step == (end - 1)->step + 1) ++end;
    takePiece(run, {begin, end}, is_first);
    if (end != run.steps.end()) gaps_.add(end->step - (end - 1)->step - 1, placeIn(run, (end - 1)->step));
    begin = end;
  }
}

// A piece can be repeated from its first snapshot. Of the first one steps before it may be missing: it began late.
void Recording::takePiece(const RecordedRun& run, std::vector<RecordedStep> steps, bool is_first) {
  const auto start = std::find_if(steps.begin(), steps.end(), [&run](const RecordedStep& step) {
    return run.snapshots.count(step.step) > 0 || (step.step == 0 && run.number <= 1);
  });
  const auto before = static_cast<std::size_t>(start - steps.begin());
  if (is_first) {
    left_out_ += before;
  } else if (before > 0) {
    unreachable_.add(before, placeIn(run, steps.front().step));
  }
  steps.erase(steps.begin(), start);
  if (steps.empty()) return;
  RecordedRun& piece = runs_.emplace_back();
  piece.number = run.number, piece.scene = run.scene, piece.info = run.info;
  piece.snapshots = {run.snapshots.lower_bound(steps.front().step), run.snapshots.upper_bound(steps.back().step)};
  piece.steps = std::move(steps);
}

void Recording::refuseWithoutInputs() const {
  std::set<std::string> ours, others;
  for (const auto& bag : bags_)
    for (const rosbag::ConnectionInfo* connection : rosbag::View(*bag).getConnections())
      (connection->datatype.rfind("vibe_msgs/", 0) == 0 || isTopic(connection->topic, "scene") ? ours : others)
          .insert(connection->topic);
  if (!ours.empty())
    refuse("has no topic applied_input with steps, which a replay repeats, but " + firstOf(ours) +
           "; if topics were chosen, keep applied_input, scene, session_info and snapshot");
  if (others.empty()) refuse("holds no message at all; record with scripts/record");
  refuse("is not of this simulator: it has no topic applied_input, but only " + firstOf(others) +
         "; record with scripts/record");
}

void Recording::refuseWithoutBegin(std::size_t snapshots) const {
  const std::string where = "has no step that a replay can begin from: it has not step 0 of the session, and ";
  if (snapshots == 0)
    refuse(where +
           "no snapshot. One is sent when a recorder comes and every 10 s; if topics were chosen, keep the topic "
           "snapshot, and if the recording was cut or split, give the part before it as well");
  refuse(where + "none of its snapshots is followed by its step; give the part after it as well");
}

std::string Recording::snapshot(const RecordedRun& run, std::uint64_t step) const {
  const ros::Time time = run.snapshots.at(step);
  for (const auto& bag : bags_) {
    rosbag::View view(*bag, rosbag::TopicQuery(prefix() + "snapshot"), time, time);
    for (const rosbag::MessageInstance& message : view) {
      const auto snapshot = instantiateGrown<vibe_msgs::StateSnapshot>(message, kFormerSnapshot);
      if (snapshot && snapshot->session == session().id && snapshot->run == run.number && snapshot->step == step)
        return {snapshot->data.begin(), snapshot->data.end()};
    }
  }
  throw Error("Recording '" + file_ + "' is damaged: its snapshot of step " + std::to_string(step) +
              " cannot be read.");
}

const std::vector<RecordingRule>& recordingRules() {
  static const std::vector<RecordingRule> rules = [] {
    std::vector<RecordingRule> all = Publishers(SinkSource(), true).recordingRules();
    for (const char* type :
         {"tf2_msgs/TFMessage", "sensor_msgs/Image", "sensor_msgs/CompressedImage", "sensor_msgs/CameraInfo"})
      all.push_back({std::string("type:") + type, kNever, false});
    return all;
  }();
  return rules;
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
