#include "replay/player.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include <ros/callback_queue.h>
#include <ros/console.h>
#include <rosbag/view.h>
#include <vibe_msgs/ProcedureEvent.h>

#include "conversions/conversions.hpp"
#include "vibe_core/clocks/step_timer.hpp"
#include "vibe_core/program/error.hpp"
#include "vibe_core/state/procedure_state.hpp"

namespace vibe::sim {
namespace {

using EventMessage = vibe_msgs::ProcedureEvent;

// Empty for kinds that are too frequent to be marked.
std::string nameOf(const EventMessage& event) {
  static const std::map<int, std::string> names = {{EventMessage::MARK, "mark"},
                                                   {EventMessage::BURN, "burn"},
                                                   {EventMessage::BITE, "bite"},
                                                   {EventMessage::SLIP, "slip"},
                                                   {EventMessage::T_TAG_DROPPED, "T-tag"},
                                                   {EventMessage::CINCHED, "cinched"},
                                                   {EventMessage::TEAR_OUT, "tear-out"},
                                                   {EventMessage::CINCH_LOOSE, "loose"},
                                                   {EventMessage::THREAD_BROKE, "thread broke"},
                                                   {EventMessage::BLEEDING_BRISK, "bleeding"}};
  if (event.kind == EventMessage::PHASE_CHANGED)
    return std::string("phase ") + toString(static_cast<Phase>(static_cast<int>(event.value)));
  const auto found = names.find(event.kind);
  return found == names.end() ? "" : found->second;
}

constexpr double kStatusPeriod = 0.1;      // [s]
constexpr double kHeartbeatPeriod = 0.08;  // of the clock while time stands still [s]
constexpr double kWholePeriod = 1;         // of the procedure's state then, as the simulator sends it [s]
constexpr double kBurst = 0.05;            // of steps before commands are looked at again [s]
constexpr double kMaxReplayLag = 0.25;     // after which lost time is given up [s]
constexpr double kMinRate = 0.01, kMaxRate = 100;

// Whether it is not of another session of this namespace. The last events come after the last step.
bool isDuring(const RecordedSession& session, const ros::Time& time) {
  return time >= session.begin && time <= session.end + ros::Duration(1);
}

}  // namespace

std::vector<ReplayMark> readMarks(const Recording& recording) {
  const std::int64_t origin = recording.runs().front().steps.front().stamp;
  std::vector<ReplayMark> marks;
  try {
    const auto view = recording.view(rosbag::TopicQuery(recording.prefix() + "procedure/events"));
    for (const rosbag::MessageInstance& message : *view) {
      const auto event = message.instantiate<EventMessage>();
      if (!event || !isDuring(recording.session(), message.getTime())) continue;
      const std::string name = nameOf(*event);
      if (!name.empty()) marks.push_back({1e-9 * static_cast<double>(fromRosTime(event->header.stamp) - origin), name});
    }
  } catch (const std::exception& error) {
    throw Error("Recording '" + recording.file() + "' is damaged (" + error.what() + ").");
  }
  std::stable_sort(marks.begin(), marks.end(), [](const auto& a, const auto& b) { return a.time < b.time; });
  return marks;
}

Player::Player(const Recording& recording, ros::NodeHandle handle, bool plays, double rate)
    : recording_(recording),
      publishers_(handle, true),
      status_(handle.advertise<vibe_msgs::ReplayStatus>("replay/status", 10, true)),
      commands_(handle.subscribe("replay/command", 100, &Player::obey, this)),
      replay_(recording, *this, Replay::Stamps::Forward) {
  message_.file = recording.file();
  message_.duration = replay_.duration();
  message_.playing = plays;
  message_.rate = rate;
  for (const ReplayMark& mark : readMarks(recording)) {
    message_.mark_times.push_back(mark.time);
    message_.marks.push_back(mark.text);
  }
  restartPace();
}

void Player::newModel(const TimedSimulation& simulation) {
  announced_run_ = simulation.run();
  publishers_.announceModel(simulation);
}

void Player::newState(const TimedSimulation& simulation) {
  if (simulation.run() != announced_run_) {
    announced_run_ = simulation.run();
    publishers_.announceRun(simulation);
  }
  publishers_.wholeState(simulation, {});
}

void Player::beforeStep(const TimedSimulation& simulation) {
  publishers_.appliedInput(simulation);
}

void Player::afterStep(const TimedSimulation& simulation) {
  publishers_.stepResult(simulation, {});
}

void Player::obey(const vibe_msgs::ReplayCommand& command) {
  if (!std::isfinite(command.rate) || command.rate < kMinRate || command.rate > kMaxRate) {
    ROS_WARN_STREAM_THROTTLE(
        1, "A message on replay/command is ignored: its rate is " << command.rate << "; it must be from 0.01 to 100.");
    return;
  }
  message_.playing = command.play;
  message_.rate = command.rate;
  if (!std::isnan(command.seek))
    attempt([&] { replay_.seek(std::min(std::max(command.seek, 0.0), replay_.duration()), command.exact); });
  restartPace();
  publishStatus(true);
}

// What cannot be shown is a sentence in the panel and no reason to end.
void Player::attempt(const std::function<void()>& move) {
  try {
    move();
    error_.clear();
  } catch (const Error& error) {
    error_ = error.what();
    message_.playing = false;
    ROS_ERROR_STREAM_THROTTLE(1, error_);
  }
}

void Player::restartPace() {
  pace_begin_ = steadyTime();
  pace_time_ = replay_.time();
}

void Player::playDueSteps() {
  const double begin = steadyTime();
  while (message_.playing && !replay_.done() && steadyTime() - begin < kBurst) {
    const double due = pace_begin_ + (replay_.time() - pace_time_) / message_.rate;
    if (steadyTime() < due) break;
    if (steadyTime() - due > kMaxReplayLag) restartPace();
    attempt([this] { replay_.step(); });
  }
  if (replay_.done()) {
    message_.playing = false;
    publishStatus(true);
  }
}

void Player::publishStatus(bool now) {
  if (!now && steadyTime() - last_status_ < kStatusPeriod) return;
  last_status_ = steadyTime();
  const ReplayResult& result = replay_.result();
  message_.header.stamp = toRosTime(replay_.simulation().now());
  message_.time = replay_.time();
  message_.checked = result.same > 0 && result.unchecked == 0;
  message_.same = !result.difference && error_.empty();
  message_.difference =
      result.difference ? result.difference->what + "; " + result.difference->cause : result.unchecked_why;
  if (!error_.empty()) message_.difference += (message_.difference.empty() ? "" : ": ") + error_;
  status_.publish(message_);
}

void Player::spinOnce() {
  ros::getGlobalCallbackQueue()->callAvailable();
  if (message_.playing) {
    playDueSteps();
  } else if (steadyTime() - last_heartbeat_ > kHeartbeatPeriod) {
    last_heartbeat_ = steadyTime();
    publishers_.heartbeat(replay_.simulation());
    if (steadyTime() - last_whole_ > kWholePeriod) {
      last_whole_ = steadyTime();
      publishers_.wholeState(replay_.simulation(), {});
    }
  }
  publishStatus(false);
}

}  // namespace vibe::sim
