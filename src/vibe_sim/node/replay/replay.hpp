#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <vibe_msgs/SessionInfo.h>

#include "recording/recording.hpp"
#include "simulation/timed_simulation.hpp"
#include "vibe_core/program/error.hpp"

namespace vibe::sim {

/// Where a replay first differs from its recording.
struct ReplayDifference {
  std::uint32_t run = 1;
  std::uint64_t step = 0;
  double time = 0;    ///< since the start of the recording [s]
  std::string what;   ///< what differs
  std::string cause;  ///< why, as far as the recording tells
};

/// A replay that differs already cannot go on, since a snapshot does not fit the model.
class ReplayEnd : public Error {
 public:
  ReplayEnd(const Error& error, ReplayDifference found, std::uint64_t steps)
      : Error(error), difference(std::move(found)), same(steps) {}
  ReplayDifference difference;
  std::uint64_t same;  ///< steps before it
};

/// How a replay compares with its recording.
struct ReplayResult {
  std::uint64_t same = 0;       ///< steps whose input and state are the recorded ones
  std::uint64_t unchecked = 0;  ///< steps without a hash that could be compared
  std::string unchecked_why;    ///< empty if all steps were checked
  std::optional<ReplayDifference> difference;
};

/// A recorded session, stepped again. Every step whose hashes were recorded is compared: its input, and the state it
/// starts from; the comparison ends at the first difference, the stepping does not.
class Replay {
 public:
  /// What happens on the way, in this order.
  struct Listener {
    virtual ~Listener() = default;
    virtual void newModel(const TimedSimulation&) {}    ///< the first, or that of a loaded scene
    virtual void newState(const TimedSimulation&) {}    ///< the first, after a reset or a load, and after seek()
    virtual void beforeStep(const TimedSimulation&) {}  ///< of step(), not of seek(); its input() is that of the step
    virtual void afterStep(const TimedSimulation&) {}
  };

  /// Stamps after seek(): those of the recording, or such as go on from where the replay was.
  enum class Stamps { Recorded, Forward };

  /// @param recording  lives as long as the replay
  /// @throws Error if the scene of the first run cannot be built, and where step() does
  Replay(const Recording& recording, Listener& listener, Stamps stamps = Stamps::Recorded);

  bool done() const;
  double time() const;      ///< of the state, since the start of the recording [s]
  double duration() const;  ///< of the recording, from its first step to its last [s]

  /// The next step. @throws Error if a run cannot be begun; ReplayEnd if that follows from a difference
  void step();

  /// Goes to the step that begins at or before a time [s], by way of the last snapshot before it.
  /// @param exact  false: stays at the snapshot
  /// @throws Error if the snapshot is damaged or of another version; ReplayEnd as step()
  void seek(double time, bool exact);

  const TimedSimulation& simulation() const { return *simulation_; }
  const ReplayResult& result() const { return result_; }

 private:
  const RecordedRun& run() const { return recording_.runs()[run_]; }
  const RecordedStep& recorded() const { return run().steps[next_]; }
  void beginRun(std::size_t run, std::size_t index);
  bool useModel(const RecordedRun& run);
  State stateAt(const RecordedRun& run, std::size_t index);
  void restore(const RecordedRun& run, std::size_t index, bool new_model);
  void prepareStep();
  void takeStep();
  void matchStamp();
  void goForward(std::int64_t before);
  double timeOf(std::size_t run, std::int64_t stamp) const;
  std::int64_t recordedNow() const { return simulation_->now() - stamp_shift_; }
  void checkRun();
  void checkStep();
  void checkEnd();
  void differ(const std::string& what, const std::string& cause);
  std::string uncheckedWhy() const;

  const Recording& recording_;
  Listener& listener_;
  std::unique_ptr<TimedSimulation> simulation_;
  std::vector<std::int64_t> begins_;  // of the runs, since the start of the recording, one after the other [ns]
  std::size_t run_ = 0;
  std::size_t next_ = 0;      // index of the step to take in its run
  std::string scene_, urdf_;  // of the model
  Stamps stamps_;
  std::int64_t stamp_shift_ = 0;  // from the recorded ones [ns]
  ReplayResult result_;
};

/// What of the information was edited after the recording, such as "the scene"; empty if nothing was.
std::string findEdit(const vibe_msgs::SessionInfo& info);

/// Why another model is built here.
std::string causeOfModel(const vibe_msgs::SessionInfo& info);

/// Why the state differs although model and inputs are the recorded ones: another version, machine or arithmetic.
std::string causeOfState(const vibe_msgs::SessionInfo& info);

}  // namespace vibe::sim
