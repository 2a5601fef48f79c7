#include "simulation/timed_simulation.hpp"

#include <cmath>
#include <utility>

namespace vibe::sim {

std::int64_t stampOf(std::int64_t origin, std::int64_t step, double period) {
  return origin + std::llround(static_cast<double>(step) * period * 1e9);
}

std::int64_t stepAt(std::int64_t origin, std::int64_t stamp, double period) {
  return std::llround(static_cast<double>(stamp - origin) / (period * 1e9));
}

std::int64_t stepsIn(double duration, double period) {
  return std::llround(duration / period);
}

void TimeLine::continueWith(std::int64_t old_step, std::int64_t new_step, double new_period) {
  if (new_period == period_) {
    shift_ += old_step + 1 - new_step;
    return;
  }
  origin_ = stamp(old_step + 1);
  period_ = new_period;
  shift_ = -new_step;
}

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
