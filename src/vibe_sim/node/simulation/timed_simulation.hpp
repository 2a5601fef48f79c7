#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "simulation/scene_source.hpp"
#include "vibe_core/simulation/simulation.hpp"

namespace vibe::sim {

/// Stamp of the first step when time is simulated: one second, because stamp 0 means "invalid" [ns].
constexpr std::int64_t kEpoch = 1'000'000'000;

/// Stamp of a step's start, in integer nanoseconds computed from its number, so that no error adds up and every
/// program that knows origin and period finds the same stamps.
/// @param origin  stamp of step 0 [ns]
/// @param period  simulated time per step [s]
std::int64_t stampOf(std::int64_t origin, std::int64_t step, double period);

/// Number of the step whose stamp is nearest to `stamp`; the inverse of stampOf().
std::int64_t stepAt(std::int64_t origin, std::int64_t stamp, double period);

/// Number of steps that a duration asks for, rounded to the nearest.
std::int64_t stepsIn(double duration, double period);

/// Which stamp belongs to which step of a state. Steps of a state count from 0 again after a reset, stamps need not:
/// the clock has its own count of steps, which only goes on.
class TimeLine {
 public:
  TimeLine(std::int64_t origin, double period) : origin_(origin), period_(period) {}

  std::int64_t stamp(std::int64_t state_step) const { return stampOf(origin_, clockStep(state_step), period_); }
  std::int64_t clockStep(std::int64_t state_step) const { return state_step + shift_; }
  /// Stamp of step 0 of the clock, which need not be that of the state [ns]. Stays while the period does and no
  /// time is given up, so that who has read it finds every later stamp to the nanosecond; and step 0 of a loaded state
  /// may lie before time 0.
  std::int64_t origin() const { return origin_; }
  double period() const { return period_; }

  /// Another state takes over: its step `new_step` gets the stamp after that of the old state's step `old_step`, so
  /// that no stamp is used twice. A new period starts a new origin.
  void continueWith(std::int64_t old_step, std::int64_t new_step, double new_period);

  /// Moves all stamps, e.g. after the simulator fell behind the wall clock [ns].
  void shiftOrigin(std::int64_t by) { origin_ += by; }

 private:
  std::int64_t origin_;
  double period_;
  std::int64_t shift_ = 0;  // clock step minus state step
};

/// A simulation with the time on its stamps and the numbers under which its messages go out. It owns a
/// vibe::Simulation, whose state and time change together only. Belongs to the stepping thread and is touched by no
/// other.
class TimedSimulation {
 public:
  /// Begins at the initial state.
  /// @param seed     of that state
  /// @param origin   stamp of its step 0 [ns]
  /// @param threads  used inside a step
  TimedSimulation(SceneModel made, std::uint64_t seed, std::int64_t origin, int threads);

  /// What the next step will use.
  void setInput(const StepInput& input) { simulation_.setInput(input); }
  /// One step with the input in force.
  void step() { simulation_.step(); }
  void warmUp() { simulation_.warmUp(); }
  void addWarnings(int count) { simulation_.addWarnings(count); }
  StepTimer& timer() { return simulation_.timer(); }

  /// Another state of the same model takes over; its stamps follow those of the old one.
  void replaceState(State new_state);
  /// Another model takes over, at its initial state.
  void replaceModel(SceneModel made);
  /// The numbers of a recording take the place of those that were counted.
  void renumber(std::uint32_t run, std::uint32_t revision);

  /// Moves all stamps, e.g. after the simulator fell behind the wall clock [ns].
  void shiftTime(std::int64_t by) { time_.shiftOrigin(by); }
  /// Time begins anew: step 0 of the state has the stamp `origin` [ns].
  void restartTime(std::int64_t origin) { time_ = TimeLine(origin, time_.period()); }

  const TimeLine& time() const { return time_; }
  std::int64_t now() const { return time_.stamp(state().step); }  ///< stamp of the state [ns]
  std::uint32_t revision() const { return revision_; }            ///< of the topology
  std::uint32_t run() const { return run_; }                      ///< one more whenever another state takes over
  /// Which start of a simulator it is, for its messages only; 0: not known.
  std::uint64_t session() const { return session_; }
  void setSession(std::uint64_t session) { session_ = session; }
  std::uint64_t seed() const { return seed_; }       ///< of the model's first state, in the published scene
  const std::string& urdf() const { return urdf_; }  ///< text that the tool was made from; empty without a tool

  const Simulation& simulation() const { return simulation_; }
  const std::shared_ptr<const Model>& sharedModel() const { return simulation_.sharedModel(); }
  const Model& model() const { return simulation_.model(); }
  const State& state() const { return simulation_.state(); }
  const StepInput& input() const { return simulation_.input(); }             ///< in force
  const std::vector<Event>& events() const { return simulation_.events(); }  ///< of the last step
  const SessionMetrics& metrics() const { return simulation_.metrics(); }
  const StepTimer& timer() const { return simulation_.timer(); }

  /// As those of Simulation, for tests that put things into the state.
  State& editState() { return simulation_.editState(); }
  void record(const std::vector<Event>& events) { simulation_.record(events); }

 private:
  Simulation simulation_;
  TimeLine time_;
  std::string urdf_;
  std::uint64_t seed_;
  std::uint64_t session_ = 0;
  std::uint32_t revision_ = 1, run_ = 1;
};

/// What the messages of a step say in addition to the simulation.
struct RunStatus {
  bool paused = false;
  bool scope_moves = false;            ///< scope/move_jp is under way
  bool suturing_device_moves = false;  ///< suturing_device/move_jp is under way
};

}  // namespace vibe::sim
