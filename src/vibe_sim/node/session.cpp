#include "session.hpp"

#include <utility>

namespace vibe::sim {
namespace {

SimulationSettings makeSettings(std::uint64_t seed, int threads) {
  SimulationSettings settings;
  settings.seed = seed;
  settings.threads = threads;
  return settings;
}

}  // namespace

Session::Session(std::shared_ptr<const Model> new_model, std::uint64_t first_seed, std::int64_t origin, int threads)
    : simulation(std::move(new_model), makeSettings(first_seed, threads)),
      time(origin, simulation.stepPeriod()),
      model(simulation.sharedModel()),
      state(simulation.state()),
      input(simulation.input()),
      events(simulation.events()) {
  seed = state.seed;
  simulation.warmUp();
}

void Session::step(const StepInput& new_input) {
  simulation.step(new_input);
}

void Session::replaceState(State new_state) {
  time.continueWith(state.step, new_state.step, simulation.stepPeriod());
  simulation.replaceState(std::move(new_state));
  ++run;
}

void Session::replaceModel(std::shared_ptr<const Model> new_model) {
  const std::int64_t old_step = state.step;
  simulation.replaceModel(std::move(new_model));
  time.continueWith(old_step, state.step, simulation.stepPeriod());
  seed = state.seed;
  ++revision;
  ++run;
}

}  // namespace vibe::sim
