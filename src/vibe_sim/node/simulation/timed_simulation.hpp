#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

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

/// The node's simulation with the time on its stamps. Belongs to the stepping thread and is touched by no other.
class Session {
 public:
  Session(std::shared_ptr<const Model> new_model, std::uint64_t first_seed, std::int64_t origin, int threads);

  /// One step with an input.
  void step(const StepInput& new_input);

  /// Another state of the same model takes over; its stamps follow those of the old one.
  void replaceState(State new_state);
  /// Another model takes over, at its initial state.
  void replaceModel(std::shared_ptr<const Model> new_model);

  std::int64_t now() const { return time.stamp(state.step); }  ///< stamp of the state [ns]
  const SessionMetrics& metrics() const { return simulation.metrics(); }
  const std::optional<ToolImpedance>& toolImpedance() const { return simulation.toolImpedance(); }

  Simulation simulation;
  TimeLine time;
  std::uint32_t revision = 1;  ///< of the topology
  std::uint32_t run = 1;       ///< one more whenever another state takes over
  std::string urdf;            ///< text that the tool was made from; empty without a tool
  std::uint64_t seed;          ///< of the model's first state, in the published scene

  // parts of the simulation
  const std::shared_ptr<const Model>& model;
  const State& state;
  const StepInput& input;            ///< in force
  const std::vector<Event>& events;  ///< of the last step
};

/// What the messages of a step say in addition to the session.
struct RunStatus {
  bool paused = false;
  bool scope_moves = false;       ///< scope/move_jp is under way
  bool overstitch_moves = false;  ///< overstitch/move_jp is under way
};

}  // namespace vibe::sim
