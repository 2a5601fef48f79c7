#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

namespace vibe::sim {

/// Lets steps begin just after the samples of an input arrive, instead of up to a period later.
///
/// Samples that come at the rate of the steps, or at twice that rate, arrive at the same places of every period; the
/// rest of the period is a gap without arrivals. The deadline of the steps is moved to the beginning of the widest
/// gap, slowly, so that the stamps stay almost regular. Samples at other rates arrive anywhere: there is no gap, and
/// the deadlines stay as they are. A phase-locked loop, with quantiles of arrivals as its phase detector, since single
/// arrivals are late now and then.
class PhaseLock {
 public:
  static constexpr std::size_t kWindow = 128;            ///< arrivals that are looked at; fewer tell nothing
  static constexpr double kLate = 0.05;                  ///< share of arrivals that may lie within the gap
  static constexpr double kGap = 0.4;                    ///< of a period: a narrower gap is none
  static constexpr double kSlew = 0.002;                 ///< of a period: max change from step to step; more than any
                                                         ///< clock is wrong
  static constexpr double kGrace = 0.1;                  ///< of a period: how long a step waits for a late sample
  static constexpr std::int64_t kMargin = 100'000;       ///< between a sample and the step that uses it [ns]
  static constexpr std::int64_t kSilence = 500'000'000;  ///< without a sample: begins anew [ns]

  /// @param period  of the steps in wall time [ns]
  explicit PhaseLock(std::int64_t period) : period_(period) {}

  /// A sample has arrived. @param time  wall time [ns]
  void arrive(std::int64_t time);

  /// By how much the deadline of the next step should move [ns], at most kSlew of a period; 0 without a gap.
  /// @param deadline  wall time at which the step is due [ns]
  std::int64_t correction(std::int64_t deadline) const;

  /// Whether a step that is due should wait a little, since its sample has not come yet.
  /// @param deadline,now  wall times [ns]
  bool awaits(std::int64_t deadline, std::int64_t now) const;

 private:
  struct Gap {
    std::int64_t begin = 0;  // phase, in [0, period) [ns]
    std::int64_t width = 0;  // [ns]
  };

  std::int64_t period_;
  std::array<std::int64_t, kWindow> times_{};  // of the last arrivals, a ring [ns]
  std::size_t arrived_ = 0;
  std::int64_t last_ = 0;  // arrival [ns]

  bool comesEveryPeriod() const;
  std::int64_t phaseOf(std::int64_t time) const;
  std::optional<Gap> findGap(std::int64_t phase, std::int64_t now) const;
};

}  // namespace vibe::sim
