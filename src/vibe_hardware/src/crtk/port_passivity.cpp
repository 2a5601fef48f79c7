#include "vibe_hardware/crtk/port_passivity.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace vibe::hardware {
namespace {

constexpr double kReservedShare = 0.1;  // of the capacity, for damping; design choice
constexpr double kFilterTime = 5e-3;    // of the velocity [s]; design choice
constexpr double kTurnTime = 0.02;      // in a shorter interval a hand does not turn round [s]; design choice
constexpr double kDampBelow = 0.75;     // of the capacity: damping is added; design choice
constexpr double kAllDampBelow = 0.25;  // of the capacity: all of it
constexpr double kFelt = 0.01;          // of the largest force: less is not missed; design choice

double strength(const PortCommand& command) {
  return std::max(std::abs(command.low), std::abs(command.high));
}

/// When command i has ceased to act. @param now  when the newest one is replaced
double endOf(const PortConfig& config, const PortState& state, std::size_t i, double now) {
  return (i + 1 < state.count ? state.commands[i + 1].begin : now) + config.delay;
}

/// Forgets commands that have ceased to act before the last measurement; the newest one stays.
void forget(const PortConfig& config, PortState& state) {
  std::size_t gone = 0;
  while (gone + 1 < state.count && endOf(config, state, gone, 0) < state.time) ++gone;
  if (gone == 0) return;
  std::move(state.commands.begin() + static_cast<std::ptrdiff_t>(gone),
            state.commands.begin() + static_cast<std::ptrdiff_t>(state.count), state.commands.begin());
  state.count -= gone;
}

void append(double now, double force, PortState& state) {
  if (state.count == PortState::kCommands) {  // the two oldest become one that may have been either
    PortCommand& second = state.commands[1];
    second.begin = state.commands[0].begin;
    second.low = std::min(second.low, state.commands[0].low);
    second.high = std::max(second.high, state.commands[0].high);
    std::move(state.commands.begin() + 1, state.commands.end(), state.commands.begin());
    --state.count;
  }
  state.commands[state.count++] = {now, force, force};
}

/// For how long each command may be the strongest of those that still act, and how strong: of itself and later ones.
struct Reserve {
  std::array<double, PortState::kCommands> time, strength;
  double sum = 0;  ///< of their products: energy per speed [N s]
};

/// From the last measurement until the commands have ceased, or `until`. @param now  when the newest one is replaced
Reserve reserveOf(const PortConfig& config, const PortState& state, double now, double until) {
  const double last = state.measured ? state.time : now;
  Reserve reserve;
  double strong = 0;
  for (std::size_t i = state.count; i-- > 0;) {
    strong = std::max(strong, strength(state.commands[i]));
    const double from = i == 0 ? last : std::max(last, endOf(config, state, i - 1, now));
    reserve.time[i] = std::max(0.0, std::min(until, endOf(config, state, i, now)) - from);
    reserve.strength[i] = strong;
    reserve.sum += reserve.time[i] * strong;
  }
  return reserve;
}

/// Largest strength of a new command with which `energy` lasts: while the commands on their way act, and the new one
/// until a next one can replace it, the hand may move with any force among them at the speed limit.
double affordable(const PortConfig& config, const PortState& state, double now, double energy) {
  const Reserve reserve = reserveOf(config, state, now, std::numeric_limits<double>::infinity());
  // what observe() books for the resolution is at most the second term
  double left = (energy - config.resolution * config.force_limit) / config.speed_limit - reserve.sum;
  if (left <= 0) return 0;
  double force = 0, time = config.hold;
  for (std::size_t i = state.count; i-- > 0;) {
    const double cost = (reserve.strength[i] - force) * time;
    if (cost >= left) break;
    left -= cost;
    force = reserve.strength[i];
    time += reserve.time[i];
  }
  return force + left / time;
}

/// Returns what silence and long intervals have cost, after a time.
void payBack(const PortConfig& config, double dt, PortState& state) {
  const double due = std::min(state.suspended, std::max(0.0, dt) * config.capacity / kReturnTime);
  state.balance = std::min(config.capacity, state.balance + due);
  state.suspended = std::min(state.suspended - due, config.capacity - state.balance);
}

}  // namespace

PortState startPort(const PortConfig& config, double now) {
  PortState state;
  state.balance = config.capacity;
  state.commands[0].begin = now - config.delay;
  return state;
}

void rebase(const PortConfig& config, double time, double position, PortState& state) {
  const double given = state.measured ? config.speed_limit * reserveOf(config, state, time, time).sum : 0;
  if (state.measured) payBack(config, time - state.time, state);
  state.balance -= given;
  state.suspended += given;
  state.time = time;
  state.position = position;
  state.velocity = 0;
  state.measured = true;
}

void observe(const PortConfig& config, double time, double position, PortState& state) {
  if (!state.measured) return rebase(config, time, position, state);
  const double dt = time - state.time;
  if (!(dt > 0)) return;
  const double motion = position - state.position;
  double low = 0, high = 0;
  bool any = false;
  for (std::size_t i = 0; i < state.count && state.commands[i].begin <= time; ++i) {
    if (i + 1 < state.count && endOf(config, state, i, time) < state.time) continue;
    low = any ? std::min(low, state.commands[i].low) : state.commands[i].low;
    high = any ? std::max(high, state.commands[i].high) : state.commands[i].high;
    any = true;
  }
  const double force = motion > 0 ? high : low;
  // the hand may be half a step beside the measured position
  const double unseen = 0.5 * config.resolution * std::abs(force - state.charged);
  // and in a long interval it may have gone with the larger force and come back against the smaller one
  const double detour = 0.5 * (config.speed_limit * dt - std::abs(motion));
  const double hidden = dt > kTurnTime ? (high - low) * std::max(0.0, detour) : 0;
  state.balance = std::min(config.capacity, state.balance - force * motion - unseen - hidden);
  state.suspended += hidden;
  if (state.released && low == 0 && high == 0) state.suspended = config.capacity - state.balance;
  payBack(config, dt, state);
  state.charged = force;
  const double kept = std::exp(-dt / kFilterTime);
  state.velocity = kept * state.velocity + (1 - kept) * motion / dt;
  state.time = time;
  state.position = position;
  forget(config, state);
}

double command(const PortConfig& config, double now, double spring, double damping, PortState& state) {
  const double wanted = std::clamp(spring, -config.force_limit, config.force_limit);
  const double spring_limit = affordable(config, state, now, state.balance - kReservedShare * config.capacity);
  const double rendered = std::clamp(wanted, -spring_limit, spring_limit);
  const double emptiness = (kDampBelow - state.balance / config.capacity) / (kDampBelow - kAllDampBelow);
  const double added = std::clamp(emptiness, 0.0, 1.0) * config.damping_limit;
  const double total = rendered - std::max(std::min(damping, config.damping_limit), added) * state.velocity;
  const double limit = std::min(config.force_limit, affordable(config, state, now, state.balance));
  const double force = std::clamp(total, -limit, limit);
  state.released = false;
  state.acts = rendered != wanted || added > 0;
  state.withheld = std::abs(wanted) > kFelt * config.force_limit ? 1 - rendered / wanted : 0;
  append(now, force, state);
  return force;
}

double release(double now, PortState& state) {
  state.released = true;
  state.acts = false;
  state.withheld = 0;
  append(now, 0, state);
  return 0;
}

}  // namespace vibe::hardware
