#pragma once

#include <memory>
#include <optional>
#include <vector>

namespace vibe {

/// Counts the peaks of a speed, which is given sample by sample. A peak counts as soon as the speed has fallen by a
/// fifth of it; the speed must have risen by a fifth of it before, and the peak must reach a threshold (Rohrer et al.
/// 2002, J Neurosci 22(18):8297, count peaks; the fifth is a design choice).
class PeakCounter {
 public:
  /// @param threshold  speed that a peak must reach, in the unit of add()
  explicit PeakCounter(double threshold) : threshold_(threshold) {}
  void add(double speed);  ///< the next sample, in any one unit of speed
  /// Ends the record. A peak from which the speed has not fallen yet also counts.
  void finish();
  int count() const { return count_; }  ///< peaks so far

 private:
  double threshold_;
  double extreme_ = 0;  // highest since the last valley, or lowest since the last peak
  bool rising_ = true;
  int count_ = 0;
};

/// SPARC, the smoothness of one movement from the spectrum of its speed: minus the length of the curve of the
/// magnitude spectrum, both axes scaled to one,
///   -integral_0^wc sqrt((1 / wc)^2 + (dV / dw)^2) dw,   V(w) = |speed spectrum| / its maximum,
/// where wc is the last frequency up to 10 Hz at which V is at least 0.05, and the record is padded with zeros to 16
/// times the next power of two: Balasubramanian, Melendez-Calderon, Roby-Brami & Burdet 2015, J NeuroEng Rehabil
/// 12:112. Negative; nearer to 0 is smoother. A minimum-jerk reach has -1.41, whatever its length and duration.
/// Made for single movements from rest to rest; for other motions it is defined but less meaningful.
///
/// Keeps the tables of the Fourier transform, so that of() does not allocate for records up to `longest`. Not for use
/// by two threads at once.
class SpectralArcLength {
 public:
  /// @param longest  samples of the longest record without new memory; about 0.7 KiB are kept for each
  explicit SpectralArcLength(int longest = 2048);
  ~SpectralArcLength();
  SpectralArcLength(const SpectralArcLength&) = delete;
  SpectralArcLength& operator=(const SpectralArcLength&) = delete;

  /// @param speed   evenly sampled, at least two samples [m/s] or [rad/s]
  /// @param period  of the samples [s]; above 50 ms the spectrum ends before 10 Hz, at half the sampling rate
  /// @return no value for a standstill, a record shorter than two samples, or one that is not finite
  std::optional<double> of(const std::vector<double>& speed, double period);

 private:
  struct Tables;
  int transform(const std::vector<double>& speed);

  std::unique_ptr<Tables> tables_;
  std::vector<double> magnitude_;
};

/// The same for a single record, without keeping tables.
std::optional<double> spectralArcLength(const std::vector<double>& speed, double period);

}  // namespace vibe
