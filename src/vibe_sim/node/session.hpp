#pragma once
#include <cstdint>
#include <memory>
#include <vector>

#include "sim_time.hpp"
#include "vibe_core/events/event.hpp"
#include "vibe_core/input/step_input.hpp"
#include "vibe_core/metrics/session_metrics.hpp"
#include "vibe_core/model/model.hpp"
#include "vibe_core/simulation/workspace.hpp"
#include "vibe_core/state/state.hpp"

namespace vibe {

/// What is simulated at the moment: belongs to the stepping thread and is touched by no other.
class Session {
 public:
  Session(std::shared_ptr<const Model> new_model, std::uint64_t seed, std::int64_t origin, int threads);

  /// One step with the present `input`; what happened is in `events` afterwards.
  void step();

  /// Another state of the same model takes over. Held commands fit the new state, so that nothing jumps.
  void replaceState(State new_state);
  /// Another model takes over, at its initial state.
  void replaceModel(std::shared_ptr<const Model> new_model);

  std::int64_t now() const { return time.stamp(state.step); }  ///< stamp of the state [ns]

  std::shared_ptr<const Model> model;
  State state;
  std::unique_ptr<Workspace> workspace;
  MetricsRecorder recorder;
  TimeLine time;
  StepInput input;             ///< what the next step uses
  std::vector<Event> events;   ///< of the last step
  std::uint32_t revision = 1;  ///< of the topology
  int threads;
};

}  // namespace vibe
