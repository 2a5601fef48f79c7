#include "replay/bag_filler.hpp"

#include <algorithm>
#include <map>
#include <vector>

#include <rosbag/view.h>

#include "conversions/conversions.hpp"
#include "recording/bag_name.hpp"
#include "recording/recording.hpp"
#include "vibe_core/metrics/session_report.hpp"
#include "vibe_core/program/error.hpp"

namespace vibe::sim {

namespace {

bool isReplayed(const std::string& topic, const std::string& prefix) {
  const RecordingRule* rule = recordingRule(topic, "", {prefix});
  return rule != nullptr && rule->replayed;
}

// Of a new session, what a recorder leaves to a replay is not written.
bool isWritten(const std::string& topic, const std::string& prefix, Filling filling) {
  if (filling == Filling::Whole) return isReplayed(topic, prefix);
  const RecordingRule* rule = recordingRule(topic, "", {prefix});
  return rule == nullptr || rule->period != kNever;
}

bool hasClock(const Recording& recording) {
  return recording.view(rosbag::TopicQuery("/clock"))->size() > 0;
}

// An open bag with the name of the file while it is incomplete.
std::unique_ptr<rosbag::Bag> begin(const std::string& file, Filling filling) {
  claimBag(file);
  auto bag = std::make_unique<rosbag::Bag>();
  try {
    bag->open(file + ".active", rosbag::bagmode::Write);
    bag->setCompression(filling == Filling::Whole ? rosbag::compression::LZ4 : rosbag::compression::BZ2);
    return bag;
  } catch (const rosbag::BagException& error) {
    bag.release();  // NOLINT: see the destructor
    throw Error("'" + file + "' cannot be written (" + error.what() + "); give a path in a writable folder.");
  }
}

bool startsWith(const std::string& text, const std::string& begin) {
  return text.rfind(begin, 0) == 0;
}

// Times of the first message of each session in the namespace.
std::map<std::uint64_t, ros::Time> firstTimes(const Recording& recording, const std::string& prefix) {
  std::map<std::uint64_t, ros::Time> first;
  const auto is_known = [&](const rosbag::ConnectionInfo* connection) {
    for (const char* topic : {"session_info", "snapshot", "applied_input", "solver_statistics"})
      if (connection->topic == prefix + topic) return true;
    return false;
  };
  const auto view = recording.view(is_known);
  for (const rosbag::MessageInstance& message : *view)
    if (const auto id = identityOf(message)) first.try_emplace(*id, message.getTime());
  return first;
}

}  // namespace

SessionFilter::SessionFilter(const Recording& recording) : prefix_(recording.prefix()), id_(recording.session().id) {
  const RecordedSession& mine = recording.session();
  std::vector<const RecordedSession*> others;
  for (const RecordedSession& each : recording.sessions())
    if (each.prefix != prefix_ && startsWith(each.prefix, prefix_)) {
      inner_.push_back(each.prefix);
    } else if (each.prefix == prefix_ && &each != &mine) {
      others.push_back(&each);
    }
  is_alone_ = others.empty();
  if (is_alone_) return;
  const auto refuse = [&](const std::string& why) {
    throw Error("Recording '" + recording.file() + "' cannot be filled: it holds several sessions in the namespace '" +
                mine.nameSpace() + "' " + why +
                ", so that messages that are only copied cannot be told apart; fill a recording of one session.");
  };
  const auto first = firstTimes(recording, prefix_);
  for (const RecordedSession* each : others) {
    if (each->id == 0 || id_ == 0) refuse("without identity");
    if (each->begin <= mine.end && each->end >= mine.begin) refuse("that overlap in time");
    if (each->begin < mine.begin) from_ = first.at(id_);
    if (each->begin > mine.end) to_ = std::min(to_, first.at(each->id));
  }
}

bool SessionFilter::has(const rosbag::MessageInstance& message) const {
  const std::string topic = message.getTopic();
  const auto holds = [&topic](const std::string& prefix) { return startsWith(topic, prefix); };
  if (is_alone_ || !holds(prefix_) || std::any_of(inner_.begin(), inner_.end(), holds)) return true;
  if (const auto id = identityOf(message)) return *id == id_;
  return message.getTime() >= from_ && message.getTime() < to_;
}

BagFiller::BagFiller(const Recording& recording, const std::string& file, Filling filling)
    : recording_(recording),
      filling_(filling),
      filter_(recording),
      bag_(begin(file, filling)),
      file_(file),
      target_{*bag_, recording.prefix(),
              [prefix = recording.prefix(), filling](const std::string& topic) {
                return isWritten(topic, prefix, filling);
              }},
      publishers_(SinkSource(target_), filling == Filling::NewSession || hasClock(recording)) {
  target_.thinned = filling == Filling::NewSession;
}

// A bag is closed by its destructor, and one that cannot be written throws there, which ends the program.
BagFiller::~BagFiller() {
  if (failed_) {
    bag_.release();  // NOLINT: better lost than closed
    return;
  }
  try {
    bag_->close();
  } catch (const rosbag::BagException&) {
    bag_.release();  // NOLINT
  }
}

void BagFiller::fail(const std::string& why) {
  failed_ = true;
  throw Error("'" + file_ + ".active' breaks off (" + why + "); make room on the disk.");
}

void BagFiller::publish(const TimedSimulation& simulation, const std::function<void()>& send) {
  target_.time = toRosTime(simulation.now());
  try {
    send();
  } catch (const rosbag::BagException& error) {
    fail(error.what());
  }
}

void BagFiller::newModel(const TimedSimulation& simulation) {
  publish(simulation, [&] { publishers_.announceModel(simulation); });
}

void BagFiller::newState(const TimedSimulation& simulation) {
  publish(simulation, [&] { publishers_.wholeState(simulation, {}); });
}

void BagFiller::beforeStep(const TimedSimulation& simulation) {
  if (filling_ == Filling::Whole) return;
  target_.thinned = static_cast<std::uint64_t>(simulation.state().step) + 1 <
                    recording_.runs().back().endStep();  // the end is kept whole
  publish(simulation, [&] { publishers_.appliedInput(simulation); });
}

void BagFiller::afterStep(const TimedSimulation& simulation) {
  publish(simulation, [&] { publishers_.stepResult(simulation, {}); });
}

void BagFiller::copyRest() {
  const auto all = recording_.view([](const rosbag::ConnectionInfo*) { return true; });
  for (const rosbag::MessageInstance& message : *all) {
    const std::string topic = message.getTopic();
    if (!isReplayed(topic, recording_.prefix()) && filter_.has(message)) bag_->write(topic, message.getTime(), message);
  }
}

// The hash after the last step, which no later input carries.
void BagFiller::sendEnd(const TimedSimulation& simulation) {
  auto end = stamped<vibe_msgs::SolverStatistics>(simulation.now());
  end.session = simulation.session();
  end.steps = static_cast<std::uint64_t>(simulation.state().step);
  end.particle_count = static_cast<std::uint32_t>(simulation.model().particle_count);
  end.state_hash = toHex(simulation.simulation().hash());
  publishers_.solverStatistics(end);
}

void BagFiller::finish(const TimedSimulation& simulation) {
  newState(simulation);
  try {
    filling_ == Filling::Whole ? copyRest() : sendEnd(simulation);
    bag_->close();
    rosbag::Bag whole(file_ + ".active", rosbag::bagmode::Read);
    count_ = rosbag::View(whole).size();
  } catch (const rosbag::BagException& error) {
    fail(error.what());
  }
  finishBag(file_);
}

}  // namespace vibe::sim
