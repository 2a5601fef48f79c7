#pragma once
#include <array>
#include <vector>

#include "track/axis_map.hpp"
#include "vibe_vision/track/marker_pattern.hpp"

namespace vibe {

/// Finds places along an axis that look like a marker: correlation of the mean grey value across a narrow band with the
/// marker's own, at the calibrated scale, for several speeds.
class AxisSearch {
 public:
  static constexpr int kCandidates = 4;
  struct Candidate {
    double along = 0;   ///< [px]
    double motion = 0;  ///< during the exposure [px]
    double score = 0;   ///< correlation coefficient
  };
  struct Result {
    std::array<Candidate, kCandidates> candidates;  ///< best first
    int count = 0;
    double darkest = 255, brightest = 0;  ///< means across the band [DN]
    bool in_view = false;                 ///< some of the band is in the frame
    double saturated = 0;                 ///< share of the band
  };

  /// @param begin, end  of the range along the axis [px]
  AxisSearch(const MarkerPattern& pattern, double begin, double end);

  /// @param begin, end      where to look, along the axis [px]
  /// @param max_motion      motion during the exposure of the fastest marker [px]
  /// @param min_contrast    white - black [DN]
  const Result& run(const AxisMap& map, const Frame& frame, double begin, double end, double max_motion,
                    double min_contrast);

 private:
  struct Score {
    double correlation = 0;
    int motion = 0;
  };
  void readBand(const AxisMap& map, const Frame& frame, double begin, double end);
  double correlate(const std::vector<float>& profile, int place, double min_contrast) const;
  void keep(int place, const Score& score);

  double first_ = 0;  ///< place of bin 0 along the axis [px]
  int reach_ = 0;     ///< half length of a profile
  double half_width_ = 0;
  std::vector<std::vector<float>> profiles_;  ///< by motion, kMotionStep apart
  AxisProfile band_;
  std::vector<float> mean_;  ///< of a bin; negative: not seen
  std::vector<Score> scores_;
  Result result_;
};

}  // namespace vibe
