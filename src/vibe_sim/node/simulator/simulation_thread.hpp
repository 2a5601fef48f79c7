#pragma once

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <functional>
#include <future>
#include <memory>
#include <mutex>
#include <string>
#include <thread>

#include "input/input_interpreter.hpp"
#include "input/input_queue.hpp"
#include "publishing/publishers.hpp"
#include "simulation/scene_source.hpp"
#include "simulation/timed_simulation.hpp"
#include "simulator/pace.hpp"
#include "simulator/parameters.hpp"
#include "simulator/run_statistics.hpp"
#include "vibe_core/simulation/snapshot.hpp"

namespace vibe::sim {

/// Answer to a service call.
struct Reply {
  bool success = false;
  std::string message;  ///< one sentence
};

/// How the stepping thread ended.
enum class Outcome {
  Stopped,   ///< somebody asked it to
  Finished,  ///< after the duration asked for
  Failed     ///< it cannot go on; it has said why
};

/// The stepping thread: takes a step whenever time, pause and inputs allow, and serves commands between two steps.
/// The simulation belongs to this thread alone, so that it needs no lock: other threads hand it work and wait for the
/// answer. From the inputs of a step to its state the thread takes no lock and, once it has settled in, asks
/// for no memory; sending messages does both, in roscpp.
class SimulationThread {
 public:
  SimulationThread(const Parameters& parameters, const SceneModel& made, InputQueue& queue, Publishers& publishers);
  ~SimulationThread();

  void start();
  /// Ends the thread after the present step; commands that still wait are answered with a failure.
  void stop();
  bool isRunning() const { return running_; }
  Outcome outcome() const { return outcome_; }

  /// A sample of the channel has arrived in the queue. From the thread that pushes samples.
  void wake(InputChannel channel);

  // Commands, from any other thread; each returns when it is done.
  Reply setPaused(bool paused);
  Reply takeSteps(std::uint32_t n);
  Reply holdBreath(bool held);
  Reply reset(std::uint64_t seed, bool keep_time);
  Reply saveSnapshot(const std::string& file);
  Reply loadSnapshot(const std::string& file, OtherScene other);
  Reply loadScene(const std::string& address);

  /// The last state to all listeners and the summary to standard output and file. Only when the thread has ended.
  void finish();

 private:
  using Answer = std::promise<Reply>;
  using Command = std::function<void(std::shared_ptr<Answer>)>;
  enum class Hold { None, Paused, Recorder, Inputs, Pace, Sample };

  // the thread
  void run();
  void loop();
  Hold findHold();
  Hold findDeadline();
  void wait(Hold hold);
  void takeStep();
  StepInput nextInput(std::int64_t stamp, bool real_time);
  void beginTiming(std::int64_t now, bool real_time);
  void endTiming();
  void reportEverySecond();
  void fail(const std::string& sentence);

  // inputs and pace
  bool mustWaitForRecorder();
  void checkPatience(Hold hold);
  void reportLag(double lag);

  // commands
  Reply call(std::function<Reply()> work);
  Reply post(Command command);
  void serveCommands();
  void rejectCommands();
  Reply changePause(bool paused);
  void answerSteps(const Reply& reply);
  void afterReplacement();

  const Parameters parameters_;
  InputQueue& queue_;
  Publishers& publishers_;

  // of the thread alone
  InputInterpreter interpreter_;
  TimedSimulation simulation_;
  Pace pace_;
  RunStatistics statistics_;
  RunStatus status_;
  std::int64_t last_step_ = 0;    // statistics_.steps after which to finish; 0: never
  vibe_msgs::StepTiming timing_;  // of the present step
  double hold_begin_ = 0;         // steady time at which the present hold began [s]
  Hold hold_ = Hold::None;
  double recorder_since_ = 0;      // steady time; 0: nobody listens yet [s]
  double last_clock_ = 0;          // steady time [s]
  double last_lag_report_ = -1e9;  // steady time [s]
  double lag_report_period_ = 0;   // until the next [s]
  double last_longest_step_ = 0;   // processor time, in the window before this one [s]
  std::uint32_t steps_asked_ = 0;  // of a running takeSteps()
  std::uint32_t steps_left_ = 0;
  std::shared_ptr<Answer> steps_answer_;

  // shared
  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<std::pair<Command, std::shared_ptr<Answer>>> commands_;
  bool accepting_ = true;
  std::atomic<bool> asked_{false};  // commands_ may hold some
  std::atomic<bool> woken_{false};  // by a sample
  std::atomic<bool> stopping_{false};
  std::atomic<bool> running_{false};
  std::atomic<Outcome> outcome_{Outcome::Stopped};
  std::thread thread_;
};

}  // namespace vibe::sim
