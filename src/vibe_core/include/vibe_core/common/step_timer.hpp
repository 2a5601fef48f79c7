#pragma once
#include <array>
#include <cstdint>

namespace vibe {

/// Distribution of durations in fixed memory: a histogram with logarithmic bins, so that median and 99th percentile
/// of a session of any length are known to within 0.5 %. Durations below 1 us and above 1000 s count as these.
class DurationHistogram {
 public:
  void add(double seconds);
  void clear();

  std::uint64_t count() const { return count_; }
  /// Smallest duration that a fraction `q` of all durations does not exceed; 0 if there are none [s].
  /// @param q  in [0, 1], e.g. 0.99
  double quantile(double q) const;
  double max() const { return max_; }                                                ///< exact [s]
  double mean() const { return count_ ? sum_ / static_cast<double>(count_) : 0.0; }  ///< exact [s]

 private:
  static constexpr int kBins = 2084;  // a factor of 1.01 each, from 1 us to 1000 s
  std::array<std::uint64_t, kBins> bins_{};
  std::uint64_t count_ = 0;
  double sum_ = 0;
  double max_ = 0;
};

/// Durations over the current window, which the owner clears when it has reported it, and over everything.
struct DurationRecord {
  DurationHistogram window;
  DurationHistogram all;

  void add(double seconds) {
    window.add(seconds);
    all.add(seconds);
  }
};

/// Measures how long a piece of work takes on the calling thread: CPU time, which does not count what other programs
/// took away from it, and wall time, which is what the user waits for. start() and stop() on the same thread.
/// Limitation: CPU time of other threads that help with the work is not counted.
class StepTimer {
 public:
  void start();
  void stop();

  DurationRecord cpu;    ///< [s]
  DurationRecord wall;   ///< [s]
  double last_cpu = 0;   ///< of the last piece of work [s]
  double last_wall = 0;  ///< of the last piece of work [s]

 private:
  double cpu_start_ = 0;
  double wall_start_ = 0;
};

/// CPU time of the calling thread since it began [s].
double threadCpuTime();
/// Time of a clock that never jumps; its zero means nothing [s].
double steadyTime();

}  // namespace vibe
