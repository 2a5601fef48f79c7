#include "pump_search.hpp"

#include <algorithm>
#include <cmath>

namespace vibe_firmware {
namespace {

constexpr float kNoLimit = 1e30F;  // capacity of an observer that never acts
constexpr double kEdge = 1e-3;     // distance from the edge of a cell, in cells
constexpr int kSweeps = 400;
constexpr double kConverged = 1e-3;  // change of a sweep, of the Coulomb friction of the shortest motion
constexpr int kRolloutTicks = 2000;

}  // namespace

PumpSearch::PumpSearch(const AxisConfig& config, const AxisParameters& parameters, const Lattice& lattice)
    : config_(config), parameters_(parameters), lattice_(lattice), cells_(2 * lattice.radius + 1) {
  config_.energy_capacity = kNoLimit;
  config_.speed_limit = kNoLimit;  // lets the search compare motions that the firmware would take for faults
  const float step = std::fabs(config.radians_per_count);
  const float range = static_cast<float>(2 * lattice.radius * lattice.stride + 1) * step;
  const float fastest = (1 - config.velocity_pole) * range / config.sample_period;
  for (int i = 0; i < lattice.velocities; ++i)
    velocities_.push_back(fastest * (2.0F * static_cast<float>(i) / static_cast<float>(lattice.velocities - 1) - 1));
  tabulate();
}

double PumpSearch::position(std::size_t place) const {
  const double inside = place % 2 == 0 ? kEdge : 1 - kEdge;
  return (count(place / 2) + inside) * config_.radians_per_count;
}

AxisState PumpSearch::stateAt(std::size_t cell, float velocity) const {
  AxisState state = initialAxisState(config_);
  state.encoder.started = true;
  state.encoder.count = count(cell);
  state.encoder.counter = static_cast<std::uint32_t>(count(cell));
  state.position = static_cast<float>(count(cell)) * config_.radians_per_count;
  state.velocity = velocity;
  state.torque = springDamperTorque(parameters_, state.position, velocity);
  state.spring_gain = 1;
  state.torque_limit = parameters_.torque_limit;
  return state;
}

PumpSearch::Transition PumpSearch::move(std::size_t from_cell, float velocity, std::size_t to_cell) const {
  AxisState state = stateAt(from_cell, velocity);
  EncoderSample sample;
  sample.counter = static_cast<std::uint32_t>(count(to_cell));
  Transition result;
  result.torque = step(config_, parameters_, 1, 32, sample, state);
  result.velocity = state.velocity;
  const double spacing = velocities_[1] - velocities_[0];
  const double scaled = (static_cast<double>(state.velocity) - velocities_[0]) / spacing;
  const double below = std::clamp(std::floor(scaled), 0.0, static_cast<double>(velocities_.size() - 2));
  result.grid = static_cast<std::size_t>(below);
  result.weight = scaled - below;
  return result;
}

void PumpSearch::tabulate() {
  for (std::size_t cell = 0; cell < cells_; ++cell)
    for (const float velocity : velocities_) {
      torque_.push_back(stateAt(cell, velocity).torque);
      for (std::size_t to = 0; to < cells_; ++to) transition_.push_back(move(cell, velocity, to));
    }
  for (std::size_t from = 0; from < places(); ++from)
    for (std::size_t to = 0; to < places(); ++to) {
      const double motion = std::fabs(position(to) - position(from));
      loss_.push_back(config_.viscous_friction * motion * motion / config_.sample_period +
                      config_.coulomb_friction * motion);
    }
  value_.assign(places() * velocities_.size(), 0);
  next_ = value_;
}

double PumpSearch::gain(std::size_t from, double torque, std::size_t to) const {
  return torque * (position(to) - position(from)) - loss_[from * places() + to];
}

/// One step of dynamic programming at all states. @return largest change
double PumpSearch::sweep() {
  const std::size_t speeds = velocities_.size();
  double change = 0;
  for (std::size_t from = 0; from < places(); ++from)
    for (std::size_t v = 0; v < speeds; ++v) {
      const std::size_t here = (from / 2) * speeds + v;
      double most = 0;  // the hand may stop
      for (std::size_t to = 0; to < places(); ++to) {
        const Transition& next = transition_[here * cells_ + to / 2];
        const double* value = &value_[index(to, next.grid)];
        const double later = (1 - next.weight) * value[0] + next.weight * value[1];
        most = std::max(most, gain(from, torque_[here], to) + later);
      }
      next_[index(from, v)] = most;
      change = std::max(change, most - value_[index(from, v)]);
    }
  value_.swap(next_);
  return change;
}

/// Best motion from a state of the real function. Staying does not count: it neither gives nor takes.
std::size_t PumpSearch::best(std::size_t place, const AxisState& state) const {
  double most = 0;
  std::size_t choice = place;
  for (std::size_t to = 0; to < places(); ++to) {
    if (to == place) continue;
    const Transition next = move(place / 2, state.velocity, to / 2);
    const double* value = &value_[index(to, next.grid)];
    const double total = gain(place, state.torque, to) + (1 - next.weight) * value[0] + next.weight * value[1];
    if (choice != place && total <= most) continue;
    most = total;
    choice = to;
  }
  return choice;
}

/// Drives the real function along the best motion. @return energy per tick in the second half
double PumpSearch::pump() const {
  std::size_t place = 2 * static_cast<std::size_t>(lattice_.radius);
  AxisState state = stateAt(place / 2, 0);
  double energy = 0;
  for (int i = 0; i < kRolloutTicks; ++i) {
    const std::size_t to = best(place, state);
    if (i >= kRolloutTicks / 2) energy += gain(place, state.torque, to);
    EncoderSample sample;
    sample.counter = static_cast<std::uint32_t>(count(to / 2));
    step(config_, parameters_, 1, 32, sample, state);
    place = to;
  }
  return energy / (kRolloutTicks / 2);
}

PumpResult PumpSearch::run() {
  const double shortest = 2 * kEdge * std::fabs(config_.radians_per_count);
  const double converged = kConverged * config_.coulomb_friction * shortest;
  const std::size_t rest = index(2 * static_cast<std::size_t>(lattice_.radius), velocities_.size() / 2);
  double half_way = 0;
  for (int i = 0; i < kSweeps; ++i) {
    if (i == kSweeps / 2) half_way = value_[rest];
    if (sweep() < converged) break;
  }
  PumpResult result;
  result.available = value_[rest];
  result.bound = std::max(0.0, value_[rest] - half_way) / (kSweeps - kSweeps / 2);
  result.gain = result.available > 0 ? pump() : 0;
  return result;
}

}  // namespace vibe_firmware
