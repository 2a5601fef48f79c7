#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "suture/wall_plan.hpp"
#include "vibe_core/model/model.hpp"
#include "vibe_core/simulation/simulation.hpp"
#include "vibe_core/state/state.hpp"

namespace vibe::benchmarks {

/// Costs of steps: one entry per step, in order [ms].
struct StepCosts {
  std::vector<double> cpu;   ///< of the thread that steps
  std::vector<double> wall;  ///< experienced by the user
};

/// Record of one sewn set.
struct SewnSet {
  int bites = 0;           ///< at cinching
  int technique = 0;       ///< Technique recognised at the T-tag
  StepCosts pulling;       ///< from the T-tag to the release of the cinch
  StepCosts after;         ///< the second after it
  double max_move = 0;     ///< fastest particle at the end of that second [m/s]
  double drawn = 0;        ///< thread [m]
  double tension = 0;      ///< in the first segment when the cinch was released [N]
  double max_tension = 0;  ///< in any segment of any set during this time [N]
  double volume = 0;       ///< at the end [m^3]
  double balance = 0;      ///< energyBalance() since the start of the session [J]
  int fallback_steps = 0;  ///< steps after which the next one takes backward Euler
  int tear_outs = 0, breaks = 0, recoveries = 0, refusals = 0, loose = 0;  ///< events
};

/// Sews sets one after the other. Bites are inserted directly into the state as the needle would take them
/// (biteAround(), through the whole wall); T-tag and cinch are operated through their buttons. The scope stays outside
/// the stomach.
class SutureSession {
 public:
  /// @param model  with gas, scope and suture
  explicit SutureSession(std::shared_ptr<const Model> model, std::uint64_t seed = 1);

  /// Steps with the insufflator on until the wall is at rest.
  /// @throws Error if it still moves after a minute of simulated time
  void settle();
  /// The same for at most this time [s].
  /// @return false if something still moves
  bool calmDown(double longest);

  /// The beginning of sew(): takes the bites and drops the T-tag.
  void tag(const std::vector<WallPoint>& spots);
  /// @param after  time to continue after the release of the cinch [s]
  /// @param drawn  thread at most that the cinch draws; empty: until its tension is reached [m]
  SewnSet sew(const std::vector<WallPoint>& spots, double after = 1, std::optional<double> drawn = {});

  /// Steps with the insufflator on for this time [s].
  void run(double duration);
  /// Goes on from the state of another session with the same particles, for example at another pressure.
  void resume(const State& state);

  const Model& model() const { return simulation_.model(); }
  const State& state() const { return simulation_.state(); }
  const std::vector<Event>& events() const { return events_; }
  SurfaceView wall() const { return {model().organ.surface.triangles, state().x, state().y, state().z}; }

 private:
  void step();
  void tag(const std::vector<WallPoint>& spots, SewnSet& set);
  void press(Button button, bool down, StepCosts& costs, SewnSet& set);
  void pull(SewnSet& set, std::optional<double> drawn);
  void count(std::size_t first_event, SewnSet& set) const;

  Simulation simulation_;
  StepInput input_;
  std::vector<Event> events_;  // since the start
  double start_balance_ = 0;
};

/// A set with these bites through the whole wall, not tagged yet, as the needle would take them.
/// @param time  of the bites [s]
Suture sutureThrough(const Model& model, const SurfaceView& wall, const std::vector<WallPoint>& spots, double time);

/// Fastest particle [m/s].
double maxSpeed(const State& state);

/// Whether the mid-surface of the wall intersects itself.
bool wallsCross(const Model& model, const State& state);

}  // namespace vibe::benchmarks
