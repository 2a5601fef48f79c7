#include "recording/recorded_sessions.hpp"

#include <algorithm>
#include <deque>
#include <tuple>
#include <utility>

#include <std_msgs/String.h>
#include <vibe_msgs/SolverStatistics.h>
#include <vibe_msgs/StateSnapshot.h>
#include <vibe_msgs/StepInput.h>

#include "conversions/conversions.hpp"
#include "vibe_core/files/number_text.hpp"
#include "vibe_core/program/error.hpp"

namespace vibe::sim {

namespace {

// MD5 sums of these types before they had an identity.
constexpr const char* kFormerInfo = "32fa7a67ace4e657f57bf111c84f40e2";
constexpr const char* kFormerStatistics = "1fc779b753795ed556d290c824fe2017";

struct TimedStep {
  ros::Time time;  // in the bag
  RecordedStep step;
};

struct TimedSnapshot {
  ros::Time time;
  std::uint32_t run;
  std::uint64_t step;
  std::int64_t stamp;
};

// Everything with one identity in one namespace, in the order of the bag's times.
struct RawSession {
  std::deque<TimedStep> steps;  // they go, one by one, when they are sorted
  std::vector<TimedSnapshot> snapshots;
  std::vector<std::pair<ros::Time, vibe_msgs::SessionInfo>> infos;
  std::multimap<std::int64_t, std::string> hashes;
};

bool isSame(const RecordedStep& a, const RecordedStep& b) {
  return a.stamp == b.stamp && a.input_hash == b.input_hash && a.state_hash == b.state_hash;
}

std::string placeOf(const RecordedStep& step) {
  return "step " + std::to_string(step.step) + " of run " + std::to_string(step.run);
}

/// Sorts the messages of the bags by identity and namespace.
class SessionReader {
 public:
  explicit SessionReader(std::string name) : name_(std::move(name)) {}

  void read(const rosbag::MessageInstance& message);
  std::vector<RecordedSession> sessions();

 private:
  using Key = std::pair<std::string, std::uint64_t>;  // namespace and identity

  RecordedStep readStep(const rosbag::MessageInstance& message);
  RawSession& raw(const rosbag::MessageInstance& message, std::uint64_t id);
  void addSession(const Key& key, RawSession& raw);
  bool mayBegin(const RawSession& raw, const RecordedStep& step) const;
  void complete(const RawSession& raw, RecordedSession& session) const;
  [[noreturn]] void refuseTwice(const RecordedStep& step) const;

  std::string name_;
  std::map<std::string, StepInputReader> readers_;  // by md5 sum of the definition
  std::map<Key, RawSession> raw_;
  std::map<std::string, std::string> scenes_;  // the first by namespace
  std::vector<RecordedSession> sessions_;
};

std::string prefixOf(const std::string& topic) {
  return topic.substr(0, topic.rfind('/') + 1);
}

RawSession& SessionReader::raw(const rosbag::MessageInstance& message, std::uint64_t id) {
  return raw_[{prefixOf(message.getTopic()), id}];
}

void SessionReader::read(const rosbag::MessageInstance& message) {
  const ros::Time time = message.getTime();
  if (message.getDataType() == ros::message_traits::datatype<vibe_msgs::StepInput>()) {
    const RecordedStep step = readStep(message);
    raw(message, step.session).steps.push_back({time, step});
  } else if (const auto snapshot = instantiateGrown<vibe_msgs::StateSnapshot>(message, kFormerSnapshot)) {
    raw(message, snapshot->session)
        .snapshots.push_back({time, snapshot->run, snapshot->step, fromRosTime(snapshot->header.stamp)});
  } else if (const auto info = instantiateGrown<vibe_msgs::SessionInfo>(message, kFormerInfo)) {
    raw(message, info->session).infos.emplace_back(time, *info);
  } else if (const auto statistics = instantiateGrown<vibe_msgs::SolverStatistics>(message, kFormerStatistics)) {
    raw(message, statistics->session).hashes.emplace(fromRosTime(statistics->header.stamp), statistics->state_hash);
  } else if (const auto scene = message.instantiate<std_msgs::String>()) {
    scenes_.try_emplace(prefixOf(message.getTopic()), scene->data);
  }
}

RecordedStep SessionReader::readStep(const rosbag::MessageInstance& message) {
  std::vector<std::uint8_t> bytes(message.size());
  ros::serialization::OStream out(bytes.data(), static_cast<std::uint32_t>(bytes.size()));
  message.write(out);
  try {
    const auto reader = readers_.try_emplace(message.getMD5Sum(), message.getMessageDefinition()).first;
    return reader->second.read(bytes.data(), bytes.size());
  } catch (const Error& error) {
    throw Error("Recording '" + name_ + "' cannot be replayed: " + error.what());
  }
}

std::vector<RecordedSession> SessionReader::sessions() {
  for (auto& [key, raw] : raw_)
    if (!raw.steps.empty()) addSession(key, raw);
  // identities begin with the time of the start, and those without are of an older release
  std::stable_sort(sessions_.begin(), sessions_.end(), [](const RecordedSession& a, const RecordedSession& b) {
    return a.id != b.id ? a.id < b.id : a.begin < b.begin;
  });
  return std::move(sessions_);
}

// Without identities a session begins anew where a step comes a second time and is another one.
void SessionReader::addSession(const Key& key, RawSession& raw) {
  RecordedSession session;
  const auto begin = [&](const TimedStep& first) {
    session = {};
    std::tie(session.prefix, session.id) = key;
    session.begin = first.time;
  };
  begin(raw.steps.front());
  std::map<std::pair<std::uint32_t, std::uint64_t>, std::size_t> seen;  // where in the steps of its run
  for (; !raw.steps.empty(); raw.steps.pop_front()) {
    const TimedStep& timed = raw.steps.front();
    const std::pair number{timed.step.run, timed.step.step};
    const auto [entry, is_new] = seen.try_emplace(number, session.runs[timed.step.run].steps.size());
    if (!is_new) {
      const RecordedStep& known = session.runs[timed.step.run].steps[entry->second];
      if (isSame(known, timed.step)) continue;  // recorded twice, or bags that were merged
      if (key.second != 0 || !mayBegin(raw, timed.step) || timed.step.stamp <= known.stamp) refuseTwice(timed.step);
      complete(raw, session);
      sessions_.push_back(std::move(session));
      seen = {{number, 0}};
      begin(timed);
    }
    session.end = timed.time;
    session.runs[timed.step.run].steps.push_back(timed.step);
  }
  complete(raw, session);
  sessions_.push_back(std::move(session));
}

// A recorder that is there gets a snapshot with the first step of a simulator.
bool SessionReader::mayBegin(const RawSession& raw, const RecordedStep& step) const {
  if (!step.has_hashes) return false;  // of a release in which a reset did not begin a run
  return step.step == 0 || std::any_of(raw.snapshots.begin(), raw.snapshots.end(), [&](const TimedSnapshot& snapshot) {
           return snapshot.run == step.run && snapshot.step == step.step && snapshot.stamp == step.stamp;
         });
}

void SessionReader::refuseTwice(const RecordedStep& step) const {
  throw Error("Recording '" + name_ + "' has " + placeOf(step) + " twice, with different content: " +
              (step.session != 0 ? "one of them may have been edited"
                                 : "one of them may have been edited, or two sessions without identities, of an older "
                                   "release, overlap in time") +
              "; give a recording of one session as it was recorded.");
}

// What belongs to the steps: snapshots by their stamps, and of each run the information that was sent before it.
void SessionReader::complete(const RawSession& raw, RecordedSession& session) const {
  const bool is_known = session.id != 0;
  for (const auto& [time, info] : raw.infos) {
    if (!is_known && session.runs.count(info.run) == 0) continue;
    RecordedRun& run = session.runs[info.run];
    const bool is_late = !is_known && time > session.end;
    if (!run.info || !is_late) run.info = info;
  }
  for (const TimedSnapshot& snapshot : raw.snapshots) {
    if (!is_known && session.runs.count(snapshot.run) == 0) continue;
    RecordedRun& run = session.runs[snapshot.run];
    const auto fits = [&](const RecordedStep& step) {
      return step.step == snapshot.step && step.stamp == snapshot.stamp;
    };
    if (std::any_of(run.steps.begin(), run.steps.end(), fits)) run.snapshots.emplace(snapshot.step, snapshot.time);
  }
  session.hashes = raw.hashes;
  const auto scene = scenes_.find(session.prefix);
  if (scene != scenes_.end()) session.scene = scene->second;
  for (auto& [number, run] : session.runs) run.number = number;
}

}  // namespace

std::size_t RecordedSession::stepCount() const {
  std::size_t count = 0;
  for (const auto& [number, run] : runs) count += run.steps.size();
  return count;
}

std::string RecordedSession::nameSpace() const {
  return prefix.size() > 1 ? prefix.substr(0, prefix.size() - 1) : "/";
}

std::string RecordedSession::idText() const {
  if (id == 0) return "-";
  return formatted("%016llx", static_cast<unsigned long long>(id));
}

std::unique_ptr<rosbag::View> viewOf(const Bags& bags,
                                     const boost::function<bool(const rosbag::ConnectionInfo*)>& query) {
  auto view = std::make_unique<rosbag::View>();
  for (const auto& bag : bags) view->addQuery(*bag, query);
  return view;
}

std::vector<RecordedSession> readSessions(const Bags& bags, const std::string& name) {
  const auto wanted = [](const rosbag::ConnectionInfo* connection) {
    for (const char* topic : {"scene", "session_info", "snapshot", "applied_input", "solver_statistics"})
      if (isTopic(connection->topic, topic)) return true;
    return false;
  };
  SessionReader reader(name);
  const auto view = viewOf(bags, wanted);
  for (const rosbag::MessageInstance& message : *view) reader.read(message);
  return reader.sessions();
}

std::optional<std::uint64_t> identityOf(const rosbag::MessageInstance& message) {
  if (const auto input = message.instantiate<vibe_msgs::StepInput>()) return input->session;
  if (const auto snapshot = message.instantiate<vibe_msgs::StateSnapshot>()) return snapshot->session;
  if (const auto info = message.instantiate<vibe_msgs::SessionInfo>()) return info->session;
  if (const auto statistics = message.instantiate<vibe_msgs::SolverStatistics>()) return statistics->session;
  return {};
}

bool isTopic(const std::string& topic, const std::string& name) {
  if (topic == name) return true;
  return topic.size() > name.size() && topic.compare(topic.size() - name.size(), name.size(), name) == 0 &&
         topic[topic.size() - name.size() - 1] == '/';
}

}  // namespace vibe::sim
