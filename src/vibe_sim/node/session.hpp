#pragma once
#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "sim_time.hpp"
#include "vibe_core/simulation/simulation.hpp"

namespace vibe::sim {

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

}  // namespace vibe::sim
