#pragma once
#include <array>
#include <cstdint>

namespace vibe {

/// Distribution of durations in fixed memory: a histogram with logarithmic bins. Median and 99th percentile are
/// accurate to 0.5 % for a session of any length. Durations below 1 us and above 1000 s are counted as these limits.
class DurationHistogram {
 public:
  /// Counts a duration [s].
  void add(double seconds);
  void clear();

  std::uint64_t count() const { return count_; }  ///< number of durations since the start or clear()
  /// Smallest duration that a fraction `q` of all durations does not exceed; 0 without durations [s].
  /// @param q  in [0, 1], e.g. 0.99
  double quantile(double q) const;
  double max() const { return max_; }                                                ///< exact [s]
  double mean() const { return count_ ? sum_ / static_cast<double>(count_) : 0.0; }  ///< exact [s]

 private:
  static constexpr int kBins = 2084;  // ratio 1.01 each, from 1 us to 1000 s
  std::array<std::uint64_t, kBins> bins_{};
  std::uint64_t count_ = 0;
  double sum_ = 0;
  double max_ = 0;
};

/// Durations over the current window and in total. The owner clears the window after reporting it.
struct DurationRecord {
  DurationHistogram window;  ///< since the owner last cleared it
  DurationHistogram all;     ///< since the record was made

  /// Counts a duration in both [s].
  void add(double seconds) {
    window.add(seconds);
    all.add(seconds);
  }
};

/// Measures a section of work on the calling thread: CPU time, which excludes time used by other programs, and wall
/// time, which the user experiences. Call start() and stop() on the same thread. Limitation: CPU time of other threads
/// that take part in the work is not counted.
class StepTimer {
 public:
  void start();  ///< a section begins
  void stop();   ///< it ends: its two times are recorded

  DurationRecord cpu;    ///< [s]
  DurationRecord wall;   ///< [s]
  double last_cpu = 0;   ///< of the last section [s]
  double last_wall = 0;  ///< of the last section [s]

 private:
  double cpu_start_ = 0;
  double wall_start_ = 0;
};

/// CPU time of the calling thread since its start [s].
double threadCpuTime();
/// Time of a monotonic clock with an arbitrary zero [s].
double steadyTime();

}  // namespace vibe
