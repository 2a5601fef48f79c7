#include "simulator/simulation_thread.hpp"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <random>

#include <ros/console.h>

#include "conversions/conversions.hpp"
#include "conversions/session_message.hpp"
#include "vibe_core/files/files.hpp"
#include "vibe_core/files/number_text.hpp"
#include "vibe_ros_utils/startup.hpp"
#include "vibe_ros_utils/wall_clock.hpp"

namespace vibe::sim {

namespace {

constexpr std::int64_t kMaxStepLag = 250'000'000;  // behind the wall clock before time is given up [ns]
constexpr double kClockHeartbeat = 0.08;           // while time stands still [s]
constexpr double kRecorderPatience = 30;           // [s]
constexpr double kRecorderSettling = 0.3;          // [s]
constexpr double kLagReportPeriod = 5;             // at first; doubled while the lag goes on [s]
constexpr double kLagReportPeriodMax = 60;         // [s]
constexpr std::chrono::milliseconds kIdle(40);
constexpr std::chrono::microseconds kSamplePoll(200);

// In the order of starts: milliseconds since 1970, and 20 random bits, since two simulators may start in the same
// instant.
std::uint64_t drawSession() {
  constexpr int kRandomBits = 20;
  const auto milliseconds = static_cast<std::uint64_t>(ros_utils::wallTime() / 1'000'000);
  return (milliseconds << kRandomBits) | (std::random_device()() & ((1U << kRandomBits) - 1));
}

std::int64_t startOrigin(const Parameters& parameters) {
  return parameters.time_source == TimeSource::Sim ? kEpoch : ros_utils::wallTime();
}

}  // namespace

SimulationThread::SimulationThread(const Parameters& parameters, const SceneModel& made, InputQueue& queue,
                                   Publishers& publishers)
    : parameters_(parameters),
      queue_(queue),
      publishers_(publishers),
      interpreter_(parameters.velocity_life),
      simulation_(made, parameters.seed.value_or(made.model->scene.seed), startOrigin(parameters), parameters.threads),
      pace_(simulation_, parameters.time_source),
      last_step_(stepsIn(parameters.duration, made.model->scene.step_period)) {
  status_.paused = parameters.start_paused;
  simulation_.setSession(drawSession());
}

SimulationThread::~SimulationThread() {
  stop();
}

void SimulationThread::start() {
  running_ = true;
  thread_ = std::thread([this] { run(); });
}

void SimulationThread::stop() {
  {
    std::lock_guard<std::mutex> lock(mutex_);  // the thread is not just about to wait
    stopping_ = true;
  }
  changed_.notify_all();
  if (thread_.joinable()) thread_.join();
}

void SimulationThread::wake(InputChannel channel) {
  if (channel == parameters_.follow) pace_.arrive(ros_utils::wallTime());
  {
    std::lock_guard<std::mutex> lock(mutex_);  // the thread is not just about to wait
    woken_ = true;
  }
  changed_.notify_all();
}

void SimulationThread::run() {
  const std::string refusal =
      parameters_.realtime_priority > 0 ? ros_utils::takeRealtimePriority(parameters_.realtime_priority) : "";
  if (!refusal.empty()) ROS_WARN_STREAM_ONCE(refusal);
  try {
    loop();
  } catch (const std::exception& error) {
    fail(error.what());
  }
  rejectCommands();
  running_ = false;
}

void SimulationThread::loop() {
  publishers_.announceModel(simulation_);
  publishers_.wholeState(simulation_, status_);
  statistics_.begin(simulation_);
  pace_.restart(ros_utils::wallTime());
  while (!stopping_) {
    pace_.collect();
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

SimulationThread::Hold SimulationThread::findHold() {
  if (status_.paused && steps_left_ == 0) return Hold::Paused;
  if (mustWaitForRecorder()) return Hold::Recorder;
  if (parameters_.lockstep && !queue_.knownUntil(simulation_.now())) return Hold::Inputs;
  // single steps are taken as fast as they can be, but stamps must not run ahead of the wall clock
  const bool hurry = steps_left_ > 0 && parameters_.time_source == TimeSource::Sim;
  if (parameters_.fast || hurry) return Hold::None;
  return findDeadline();
}

SimulationThread::Hold SimulationThread::findDeadline() {
  const std::int64_t now = ros_utils::wallTime();
  const std::int64_t late = now - pace_.deadline();
  if (late < -Pace::kClockJump) pace_.restart(now);
  if (late < 0 || now < pace_.earliestBegin()) return Hold::Pace;
  if (parameters_.follow && pace_.awaitsSample(now)) return Hold::Sample;
  if (static_cast<double>(late) > 1e9 * simulation_.time().period()) ++statistics_.missed_deadlines;
  if (late > kMaxStepLag) {
    reportLag(1e-9 * static_cast<double>(late));
    pace_.restart(now);
  }
  return Hold::None;
}

bool SimulationThread::mustWaitForRecorder() {
  if (!parameters_.await_recorder || statistics_.steps > 0) return false;
  if (!publishers_.hasRecorder()) {
    recorder_since_ = 0;
    return true;
  }
  // its connections to the other topics come at about the same time
  if (recorder_since_ == 0) recorder_since_ = steadyTime();
  return steadyTime() - recorder_since_ < kRecorderSettling;
}

void SimulationThread::wait(Hold hold) {
  const double now = steadyTime();
  if (hold != hold_) hold_begin_ = now;
  hold_ = hold;
  const bool time_stands_still = hold != Hold::Pace && hold != Hold::Sample;
  if (time_stands_still && now - std::max(last_clock_, hold_begin_) >= kClockHeartbeat) {
    publishers_.heartbeat(simulation_);
    last_clock_ = now;
  }
  checkPatience(hold);
  queue_.collect();
  std::unique_lock<std::mutex> lock(mutex_);
  std::chrono::nanoseconds duration = kIdle;
  if (hold == Hold::Pace)
    duration = std::min(duration, std::chrono::nanoseconds(pace_.earliestBegin() - ros_utils::wallTime()));
  if (hold == Hold::Sample) duration = kSamplePoll;
  // inputs matter to a step only when it is due, so that their arrival ends no other wait
  const bool inputs_matter = hold == Hold::Inputs || hold == Hold::Sample;
  changed_.wait_for(lock, duration, [&] { return stopping_ || asked_ || (inputs_matter && woken_); });
  woken_ = false;
  // time spent waiting for others is not lag of the simulation
  if (hold == Hold::Inputs || hold == Hold::Recorder) pace_.restart(ros_utils::wallTime());
}

void SimulationThread::checkPatience(Hold hold) {
  const double waited = steadyTime() - hold_begin_;
  if (hold == Hold::Recorder && waited > kRecorderPatience) {
    fail("Nobody listens to applied_input although ~await_recorder is set; start the recorder or do not set it.");
  }
  if (hold != Hold::Inputs || waited < parameters_.lockstep_timeout) return;
  const std::string sentence = "No message stamped " + std::to_string(1e-9 * static_cast<double>(simulation_.now())) +
                               " s or later has come on " + queue_.missingAt(simulation_.now()) + " for " +
                               std::to_string(static_cast<int>(waited)) + " s, which ~lockstep needs; ";
  answerSteps({false, sentence + "the simulation stays paused."});
  if (parameters_.duration > 0) {
    fail(sentence + "start the node that sends it.");
    return;
  }
  ROS_ERROR_STREAM(sentence << "the simulation is paused: start the node that sends it and call the service pause.");
  publishers_.warn(sentence + "the simulation is paused.");
  status_.paused = true;
  publishers_.procedureState(simulation_, status_);
}

void SimulationThread::takeStep() {
  hold_ = Hold::None;
  if (statistics_.steps == 0) statistics_.begin(simulation_);
  statistics_.total.start();
  const bool real_time = !parameters_.fast && !parameters_.lockstep && steps_left_ == 0;
  const std::int64_t now = ros_utils::wallTime();
  beginTiming(now, real_time);
  pace_.begin(now);
  const StepInput input = nextInput(pace_.inputTime(now, queue_.now()), real_time);
  status_.scope_moves = interpreter_.moves(InputChannel::Scope);
  status_.suturing_device_moves = interpreter_.moves(InputChannel::SuturingDevice);
  simulation_.addWarnings(publishers_.takeWarnings());
  simulation_.setInput(input);
  publishers_.appliedInput(simulation_);
  simulation_.step();
  timing_.solved = toRosTime(ros_utils::wallTime());
  statistics_.publish.start();
  publishers_.stepResult(simulation_, status_);
  statistics_.publish.stop();
  endTiming();
  if (real_time && parameters_.follow) pace_.follow();
  last_clock_ = steadyTime();
  statistics_.countStep(simulation_.time().period(), simulation_.simulation().report());
  statistics_.total.stop();
  if (steps_left_ > 0 && --steps_left_ == 0) {
    publishers_.procedureState(simulation_, status_);  // it is sent once a second, and time now stands still
    answerSteps({true, "Took " + std::to_string(steps_asked_) + " steps."});
  }
}

StepInput SimulationThread::nextInput(std::int64_t stamp, bool real_time) {
  const DueInput& due = queue_.takeDue(stamp);
  StepInput input = simulation_.input();
  for (const std::string& sentence :
       interpreter_.interpret(due, simulation_.model(), input, simulation_.state().joints))
    publishers_.complain(sentence);
  const std::string released = real_time ? releaseSilentButtons(due, input) : "";
  if (!released.empty()) publishers_.complain(released);
  return input;
}

void SimulationThread::beginTiming(std::int64_t now, bool real_time) {
  timing_.step = simulation_.state().step;
  timing_.due = toRosTime(real_time ? std::min(pace_.deadline(), now) : now);
  timing_.begin = toRosTime(now);
}

void SimulationThread::endTiming() {
  if (!publishers_.hasTimingListener()) return;
  timing_.header.stamp = toRosTime(simulation_.now());
  timing_.published = toRosTime(ros_utils::wallTime());
  setWork(simulation_.simulation().report(), timing_);
  publishers_.stepTiming(timing_);
}

void SimulationThread::reportEverySecond() {
  if (!statistics_.windowIsOver()) return;
  publishers_.solverStatistics(statistics_.windowMessage(simulation_));
  std::printf("%s%s\n", statistics_.progressLine(simulation_).c_str(), status_.paused ? "  (paused)" : "");
  std::fflush(stdout);
  last_longest_step_ = simulation_.timer().cpu.window.max();
  statistics_.startWindow(simulation_);
}

void SimulationThread::fail(const std::string& sentence) {
  ROS_ERROR_STREAM(sentence);
  publishers_.warn(sentence);
  outcome_ = Outcome::Failed;
}

void SimulationThread::reportLag(double lag) {
  const double now = steadyTime();
  const double since = now - last_lag_report_;
  if (since < lag_report_period_) return;
  const bool goes_on = since < 2 * lag_report_period_;
  lag_report_period_ = goes_on ? std::min(2 * lag_report_period_, kLagReportPeriodMax) : kLagReportPeriod;
  last_lag_report_ = now;
  const DurationRecord& cpu = simulation_.timer().cpu;
  const double longest = std::max(cpu.window.max(), last_longest_step_), period = simulation_.time().period();
  const double usual = cpu.all.quantile(0.5);
  const std::string sentence = formatted(
      "The simulation is %.2f s behind the wall clock and gives that time up: a step simulates %.1f ms and takes "
      "%.1f ms of processor time in the median, lately %.1f ms at most; %s.",
      lag, 1e3 * period, 1e3 * usual, 1e3 * longest, lagRemedy(usual, longest, period));
  ROS_WARN_STREAM(sentence);
  publishers_.warn(sentence);
}

void SimulationThread::finish() {
  simulation_.addWarnings(publishers_.takeWarnings());
  publishers_.wholeState(simulation_, status_);
  publishers_.solverStatistics(statistics_.wholeMessage(simulation_));
  const std::string summary = statistics_.summary(simulation_);
  std::fputs(summary.c_str(), stdout);
  std::fflush(stdout);
  if (!parameters_.summary_file.empty()) writeFile(parameters_.summary_file, summary, "The summary");
}

}  // namespace vibe::sim
