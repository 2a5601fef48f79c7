#pragma once

namespace vibe {

/// Counts the peaks of a speed, which is given sample by sample. A peak counts as soon as the speed has fallen by a
/// fifth of it; the speed must have risen by a fifth of it before, and the peak must reach a threshold (Rohrer et al.
/// 2002, J Neurosci 22(18):8297, count peaks; the fifth is a design choice).
class PeakCounter {
 public:
  explicit PeakCounter(double threshold) : threshold_(threshold) {}
  void add(double speed);
  /// Ends the record. A peak from which the speed has not fallen yet also counts.
  void finish();
  int count() const { return count_; }

 private:
  double threshold_;
  double extreme_ = 0;  // highest since the last valley, or lowest since the last peak
  bool rising_ = true;
  int count_ = 0;
};

}  // namespace vibe
