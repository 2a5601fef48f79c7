#include "simulator/pace.hpp"

#include <algorithm>
#include <cmath>

namespace vibe::sim {
namespace {

// Late steps begin so much earlier than the step period after one another at most. With a burst, the tool would jump
// and the force of the tissue with it.
constexpr int kMaxHurry = 2;

std::int64_t inNanoseconds(double seconds) {
  return std::llround(1e9 * seconds);
}

}  // namespace

Pace::Pace(TimedSimulation& simulation, TimeSource source)
    : simulation_(simulation), source_(source), lock_(inNanoseconds(simulation.time().period())) {}

void Pace::collect() {
  arrivals_.consume_all([this](std::int64_t time) { lock_.arrive(time); });
}

void Pace::forgetSamples() {
  lock_ = PhaseLock(inNanoseconds(simulation_.time().period()));
}

std::int64_t Pace::deadline() const {
  return simulation_.time().stamp(simulation_.state().step + 1) + offset_ + follow_shift_;
}

std::int64_t Pace::earliestBegin() const {
  return std::max(deadline(), last_begin_ + inNanoseconds(simulation_.time().period()) / kMaxHurry);
}

std::int64_t Pace::inputTime(std::int64_t now, std::int64_t last) const {
  if (source_ == TimeSource::Sim) return simulation_.now();
  const std::int64_t due = deadline();
  return now - due > inNanoseconds(simulation_.time().period()) ? std::max(due, last) : now;
}

// The shift counts from here on, and not from when it was found: the stamp of a state that has been published must not
// change.
void Pace::begin(std::int64_t now) {
  last_begin_ = now;
  if (source_ == TimeSource::Sim) {
    offset_ += follow_shift_;
  } else {
    simulation_.shiftTime(follow_shift_);
  }
  follow_shift_ = 0;
}

void Pace::follow() {
  collect();
  follow_shift_ = lock_.correction(deadline());
}

void Pace::restart(std::int64_t now) {
  last_begin_ = std::min(last_begin_, now);  // somebody may have set the clock back
  const std::int64_t shift = now - deadline();
  if (source_ == TimeSource::Sim) {
    offset_ += shift;
  } else if (shift > 0 || shift < -kClockJump) {
    // stamps never go back, unless the wall clock itself did
    simulation_.shiftTime(shift);
  }
}

}  // namespace vibe::sim
