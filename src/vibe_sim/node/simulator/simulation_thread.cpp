#include "simulator/simulation_thread.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>

#include <ros/console.h>

#include "conversions/conversions.hpp"
#include "vibe_core/common/write_file.hpp"
#include "vibe_node/startup.hpp"
#include "vibe_node/wall_clock.hpp"

namespace vibe::sim {

namespace {

constexpr std::int64_t kMaxStepLag = 250'000'000;   // behind the wall clock before time is given up [ns]
constexpr std::int64_t kClockJump = 1'000'000'000;  // ahead of it: somebody has set the wall clock back [ns]
constexpr double kClockHeartbeat = 0.08;            // while time stands still [s]
constexpr double kRecorderPatience = 30;            // [s]
constexpr double kRecorderSettling = 0.3;           // [s]
constexpr double kLagReportPeriod = 5;              // at first; doubled while the lag goes on [s]
constexpr double kLagReportPeriodMax = 60;          // [s]
constexpr std::chrono::milliseconds kIdle(40);
constexpr std::chrono::microseconds kSamplePoll(200);

// Late steps begin so much earlier than the step period after one another at most. With a burst, the tool would jump
// and the force of the tissue with it.
constexpr int kMaxHurry = 2;

std::int64_t inNanoseconds(double seconds) {
  return std::llround(1e9 * seconds);
}

std::int64_t startOrigin(const Parameters& parameters) {
  return parameters.time_source == TimeSource::Sim ? kEpoch : node::wallTime();
}

}  // namespace

Stepper::Stepper(const Parameters& parameters, const SceneModel& made, InputQueue& queue, Publishers& publishers)
    : parameters_(parameters),
      queue_(queue),
      publishers_(publishers),
      session_(made.model, parameters.seed.value_or(made.model->scene.seed), startOrigin(parameters),
               parameters.threads),
      last_step_(stepsIn(parameters.duration, made.model->scene.step_period)),
      lock_(inNanoseconds(made.model->scene.step_period)) {
  session_.urdf = made.urdf;
  status_.paused = parameters.start_paused;
}

Stepper::~Stepper() {
  stop();
}

void Stepper::start() {
  running_ = true;
  thread_ = std::thread([this] { run(); });
}

void Stepper::stop() {
  {
    std::lock_guard<std::mutex> lock(mutex_);  // the thread is not just about to wait
    stopping_ = true;
  }
  changed_.notify_all();
  if (thread_.joinable()) thread_.join();
}

void Stepper::wake(InputChannel channel) {
  if (channel == parameters_.follow) arrivals_.push(node::wallTime());
  {
    std::lock_guard<std::mutex> lock(mutex_);  // the thread is not just about to wait
    woken_ = true;
  }
  changed_.notify_all();
}

void Stepper::run() {
  const std::string refusal =
      parameters_.realtime_priority > 0 ? node::takeRealtimePriority(parameters_.realtime_priority) : "";
  if (!refusal.empty()) ROS_WARN_STREAM_ONCE(refusal);
  try {
    loop();
  } catch (const std::exception& error) {
    fail(error.what());
  }
  rejectCommands();
  running_ = false;
}

void Stepper::loop() {
  publishers_.announceModel(session_);
  publishers_.wholeState(session_, status_);
  statistics_.begin(session_);
  restartPace(node::wallTime());
  while (!stopping_) {
    hearArrivals();
    serveCommands();
    if (last_step_ > 0 && statistics_.steps >= last_step_) {
      outcome_ = Outcome::Finished;
      return;
    }
    const Hold hold = findHold();
    if (hold == Hold::None) {
      takeStep();
    } else {
      wait(hold);
      if (outcome_ == Outcome::Failed) return;
    }
    reportEverySecond();
  }
}

Stepper::Hold Stepper::findHold() {
  if (status_.paused && steps_left_ == 0) return Hold::Paused;
  if (mustWaitForRecorder()) return Hold::Recorder;
  if (parameters_.lockstep && !queue_.knownUntil(session_.now())) return Hold::Inputs;
  // single steps are taken as fast as they can be, but stamps must not run ahead of the wall clock
  const bool hurry = steps_left_ > 0 && parameters_.time_source == TimeSource::Sim;
  if (parameters_.fast || hurry) return Hold::None;
  return findDeadline();
}

Stepper::Hold Stepper::findDeadline() {
  const std::int64_t now = node::wallTime();
  const std::int64_t late = now - nextDeadline();
  if (late < -kClockJump) restartPace(now);
  if (late < 0 || now < nextBegin()) return Hold::Pace;
  if (parameters_.follow && lock_.awaits(nextDeadline(), now)) return Hold::Sample;
  if (static_cast<double>(late) > 1e9 * session_.time.period()) ++statistics_.missed_deadlines;
  if (late > kMaxStepLag) {
    reportLag(1e-9 * static_cast<double>(late));
    restartPace(now);
  }
  return Hold::None;
}

bool Stepper::mustWaitForRecorder() {
  if (!parameters_.await_recorder || statistics_.steps > 0) return false;
  if (!publishers_.hasRecorder()) {
    recorder_since_ = 0;
    return true;
  }
  // its connections to the other topics come at about the same time
  if (recorder_since_ == 0) recorder_since_ = steadyTime();
  return steadyTime() - recorder_since_ < kRecorderSettling;
}

void Stepper::wait(Hold hold) {
  const double now = steadyTime();
  if (hold != hold_) hold_begin_ = now;
  hold_ = hold;
  const bool time_stands_still = hold != Hold::Pace && hold != Hold::Sample;
  if (time_stands_still && now - std::max(last_clock_, hold_begin_) >= kClockHeartbeat) {
    publishers_.heartbeat(session_);
    last_clock_ = now;
  }
  checkPatience(hold);
  queue_.collect();
  std::unique_lock<std::mutex> lock(mutex_);
  std::chrono::nanoseconds duration = kIdle;
  if (hold == Hold::Pace) duration = std::min(duration, std::chrono::nanoseconds(nextBegin() - node::wallTime()));
  if (hold == Hold::Sample) duration = kSamplePoll;
  // inputs matter to a step only when it is due, so that their arrival ends no other wait
  const bool inputs_matter = hold == Hold::Inputs || hold == Hold::Sample;
  changed_.wait_for(lock, duration, [&] { return stopping_ || asked_ || (inputs_matter && woken_); });
  woken_ = false;
  // time spent waiting for others is not lag of the simulation
  if (hold == Hold::Inputs || hold == Hold::Recorder) restartPace(node::wallTime());
}

void Stepper::checkPatience(Hold hold) {
  const double waited = steadyTime() - hold_begin_;
  if (hold == Hold::Recorder && waited > kRecorderPatience) {
    fail("Nobody listens to applied_input although ~await_recorder is set; start the recorder or do not set it.");
  }
  if (hold != Hold::Inputs || waited < parameters_.lockstep_timeout) return;
  const std::string sentence = "No message stamped " + std::to_string(1e-9 * static_cast<double>(session_.now())) +
                               " s or later has come on " + queue_.missingAt(session_.now()) + " for " +
                               std::to_string(static_cast<int>(waited)) + " s, which ~lockstep needs; ";
  answerSteps({false, sentence + "the simulation stays paused."});
  if (parameters_.duration > 0) {
    fail(sentence + "start the node that sends it.");
    return;
  }
  ROS_ERROR_STREAM(sentence << "the simulation is paused: start the node that sends it and call the service pause.");
  publishers_.warn(sentence + "the simulation is paused.");
  status_.paused = true;
  publishers_.procedureState(session_, status_);
}

void Stepper::takeStep() {
  hold_ = Hold::None;
  if (statistics_.steps == 0) statistics_.begin(session_);
  statistics_.total.start();
  const bool real_time = !parameters_.fast && !parameters_.lockstep && steps_left_ == 0;
  const std::int64_t now = node::wallTime();
  beginTiming(now, real_time);
  StepInput input = session_.input;
  for (const std::string& sentence :
       queue_.apply(inputTime(now), *session_.model, input, real_time, session_.state.joints))
    complain(sentence);
  status_.scope_moves = queue_.moves(InputChannel::Scope);
  status_.overstitch_moves = queue_.moves(InputChannel::Overstitch);
  session_.simulation.addWarnings(publishers_.takeWarnings());
  session_.simulation.setInput(input);
  publishers_.appliedInput(session_);
  session_.step(input);
  timing_.solved = toRosTime(node::wallTime());
  statistics_.publish.start();
  publishers_.stepResult(session_, status_);
  statistics_.publish.stop();
  endTiming();
  if (real_time && parameters_.follow) followInput();
  last_clock_ = steadyTime();
  statistics_.countStep(session_.time.period(), session_.simulation.report());
  statistics_.total.stop();
  if (steps_left_ > 0 && --steps_left_ == 0) {
    publishers_.procedureState(session_, status_);  // it is sent once a second, and time now stands still
    answerSteps({true, "Took " + std::to_string(steps_asked_) + " steps."});
  }
}

void Stepper::beginTiming(std::int64_t now, bool real_time) {
  timing_.step = session_.state.step;
  timing_.due = toRosTime(real_time ? std::min(nextDeadline(), now) : now);
  timing_.begin = toRosTime(now);
  last_begin_ = now;
  // not before: the stamp of a state that has been published must not change
  if (parameters_.time_source == TimeSource::Sim) {
    pace_offset_ += follow_shift_;
  } else {
    session_.time.shiftOrigin(follow_shift_);
  }
  follow_shift_ = 0;
}

void Stepper::endTiming() {
  if (!publishers_.hasTimingListener()) return;
  timing_.header.stamp = toRosTime(session_.now());
  timing_.published = toRosTime(node::wallTime());
  publishers_.stepTiming(timing_);
}

// Of a command that is sent 100 times a second, one sentence a second is enough.
void Stepper::complain(const std::string& sentence) {
  double& last = complaints_.try_emplace(sentence.substr(0, sentence.find(' ')), -1e9).first->second;
  const double now = steadyTime();
  if (now - last < kComplaintPeriod) return;
  last = now;
  ROS_WARN_STREAM(sentence);
  publishers_.warn(sentence);
}

void Stepper::reportEverySecond() {
  if (!statistics_.windowIsOver()) return;
  publishers_.solver_statistics(statistics_.windowMessage(session_));
  std::printf("%s%s\n", statistics_.progressLine(session_).c_str(), status_.paused ? "  (paused)" : "");
  std::fflush(stdout);
  statistics_.startWindow(session_);
}

void Stepper::fail(const std::string& sentence) {
  ROS_ERROR_STREAM(sentence);
  publishers_.warn(sentence);
  outcome_ = Outcome::Failed;
}

std::int64_t Stepper::nextDeadline() const {
  return session_.time.stamp(session_.state.step + 1) + pace_offset_ + follow_shift_;
}

// When the next step may begin [ns of the wall clock].
std::int64_t Stepper::nextBegin() const {
  return std::max(nextDeadline(), last_begin_ + inNanoseconds(session_.time.period()) / kMaxHurry);
}

// Until which stamp samples count for the next step. A step that makes up for lost time uses what was known at its own
// time, so that a motion keeps its form.
std::int64_t Stepper::inputTime(std::int64_t now) const {
  if (parameters_.time_source == TimeSource::Sim) return session_.now();
  const std::int64_t due = nextDeadline();
  // never before that of the step before
  return now - due > inNanoseconds(session_.time.period()) ? std::max(due, queue_.now()) : now;
}

void Stepper::hearArrivals() {
  arrivals_.consume_all([this](std::int64_t time) { lock_.arrive(time); });
}

void Stepper::followInput() {
  hearArrivals();
  follow_shift_ = lock_.correction(nextDeadline());
}

void Stepper::restartPace(std::int64_t now) {
  last_begin_ = std::min(last_begin_, now);  // somebody may have set the clock back
  const std::int64_t shift = now - nextDeadline();
  if (parameters_.time_source == TimeSource::Sim) {
    pace_offset_ += shift;
  } else if (shift > 0 || shift < -kClockJump) {
    // stamps never go back, unless the wall clock itself did
    session_.time.shiftOrigin(shift);
  }
}

void Stepper::reportLag(double lag) {
  const double now = steadyTime();
  const double since = now - last_lag_report_;
  if (since < lag_report_period_) return;
  const bool goes_on = since < 2 * lag_report_period_;
  lag_report_period_ = goes_on ? std::min(2 * lag_report_period_, kLagReportPeriodMax) : kLagReportPeriod;
  last_lag_report_ = now;
  const double step = statistics_.total.wall.all.quantile(0.5), period = session_.time.period();
  const char* remedy = step < period ? "stop other programs, or use fewer particles if single steps are long"
                                     : "use fewer particles or substeps";
  char sentence[320];
  std::snprintf(sentence, sizeof sentence,
                "The simulation is %.2f s behind the wall clock and gives that time up: the median step takes %.1f ms "
                "and simulates %.1f ms; %s.",
                lag, 1e3 * step, 1e3 * period, remedy);
  ROS_WARN_STREAM(sentence);
  publishers_.warn(sentence);
}

void Stepper::finish() {
  session_.simulation.addWarnings(publishers_.takeWarnings());
  publishers_.wholeState(session_, status_);
  publishers_.solver_statistics(statistics_.wholeMessage(session_));
  const std::string summary = statistics_.summary(session_);
  std::fputs(summary.c_str(), stdout);
  std::fflush(stdout);
  if (!parameters_.summary_file.empty()) writeFile(parameters_.summary_file, summary, "The summary");
}

}  // namespace vibe::sim
