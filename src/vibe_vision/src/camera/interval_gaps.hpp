#pragma once
#include <cstdint>

namespace vibe::vision {

/// Tells frames that were left out from the stamps of the others, for drivers that tell no numbers. The period is the
/// one that was asked for, and from then on the shortest interval of the last frames: a camera that runs more slowly
/// than asked, for example in the dark, loses nothing.
class IntervalGaps {
 public:
  /// @param period  that was asked for [s]
  explicit IntervalGaps(double period) : period_(period) {}
  /// @return frames between the last stamp and this one
  std::uint64_t advance(double stamp);

 private:
  double period_, last_ = 0, shortest_ = 0;
  int intervals_ = 0;

  void learn(double interval);
};

}  // namespace vibe::vision
