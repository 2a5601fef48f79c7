#pragma once
#include <boost/lockfree/spsc_queue.hpp>
#include <cstdint>

#include "simulation/timed_simulation.hpp"
#include "simulator/parameters.hpp"
#include "simulator/phase_lock.hpp"

namespace vibe::sim {

/// When steps are due in wall time, and how they make up for lost time or follow the samples of an input. Belongs to
/// the stepping thread, but for arrive(). All times are of the wall clock [ns] unless another is named.
class Pace {
 public:
  /// So far ahead of the wall clock somebody has set it back.
  static constexpr std::int64_t kClockJump = 1'000'000'000;

  /// @param simulation  lives as long as the pace; where stamps are those of the wall clock, the pace moves them
  Pace(TimedSimulation& simulation, TimeSource source);

  /// A sample of the input that steps follow has come. From the thread that pushes samples.
  void arrive(std::int64_t time) { arrivals_.push(time); }
  /// Looks at what has arrived.
  void collect();
  /// Follows samples from now on as if none had come yet, because the period may be another one.
  void forgetSamples();

  /// When the next step is due.
  std::int64_t deadline() const;
  /// When the next step may begin.
  std::int64_t earliestBegin() const;
  /// Whether a step that is due should wait a little for its sample.
  bool awaitsSample(std::int64_t now) const { return lock_.awaits(deadline(), now); }
  /// Until which stamp samples count for the next step [ns of the simulator's time]. A step that makes up for lost time
  /// uses what was known at its own time, so that a motion keeps its form.
  /// @param last  of the step before
  std::int64_t inputTime(std::int64_t now, std::int64_t last) const;

  /// A step begins now.
  void begin(std::int64_t now);
  /// The step after this one is due a little earlier or later, as the samples ask.
  void follow();
  /// The next step is due now: time before does not count.
  void restart(std::int64_t now);

 private:
  TimedSimulation& simulation_;
  const TimeSource source_;
  std::int64_t offset_ = 0;        // wall clock minus stamp at which a step is due [ns]
  std::int64_t follow_shift_ = 0;  // by which the next step is due later than its stamp says [ns]
  std::int64_t last_begin_ = 0;
  PhaseLock lock_;  // to the samples
  boost::lockfree::spsc_queue<std::int64_t, boost::lockfree::capacity<256>> arrivals_;
};

}  // namespace vibe::sim
