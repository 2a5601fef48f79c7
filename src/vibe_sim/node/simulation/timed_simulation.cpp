#include "simulation/timed_simulation.hpp"

#include <cmath>
#include <utility>

namespace vibe::sim {
namespace {

SimulationSettings makeSettings(std::uint64_t seed, int threads) {
  SimulationSettings settings;
  settings.stages = true;
  settings.seed = seed;
  settings.threads = threads;
  return settings;
}

}  // namespace

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

TimedSimulation::TimedSimulation(SceneModel made, std::uint64_t seed, std::int64_t origin, int threads)
    : simulation_(std::move(made.model), makeSettings(seed, threads)),
      time_(origin, simulation_.stepPeriod()),
      urdf_(std::move(made.urdf)),
      seed_(state().seed) {
  simulation_.warmUp();
}

void TimedSimulation::replaceState(State new_state) {
  time_.continueWith(state().step, new_state.step, simulation_.stepPeriod());
  simulation_.replaceState(std::move(new_state));
  ++run_;
}

void TimedSimulation::replaceModel(SceneModel made) {
  const std::int64_t old_step = state().step;
  simulation_.replaceModel(std::move(made.model));
  time_.continueWith(old_step, state().step, simulation_.stepPeriod());
  urdf_ = std::move(made.urdf);
  seed_ = state().seed;
  ++revision_;
  ++run_;
}

void TimedSimulation::renumber(std::uint32_t run, std::uint32_t revision) {
  run_ = run;
  revision_ = revision;
}

}  // namespace vibe::sim
