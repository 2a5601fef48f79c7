#pragma once
#include <array>
#include <vector>

#include "track/axis_map.hpp"
#include "track/search_template.hpp"

namespace vibe::vision {

/// Finds places along an axis that look like a marker: correlation of the mean grey value across a narrow band with the
/// marker's own, for several speeds and sizes and any rotation.
class AxisSearch {
 public:
  static constexpr int kCandidates = 4;
  struct Candidate {
    double along = 0;     ///< [px]
    double motion = 0;    ///< during the exposure [px]
    double scale = 1;     ///< relative to the calibrated one
    double rotation = 0;  ///< [rad]
    bool shows_rotation = false;
    double score = 0;  ///< correlation coefficient
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
  double begin() const { return begin_; }
  double end() const { return end_; }

  /// @param begin, end      where to look, along the axis [px]
  /// @param max_motion      motion during the exposure of the fastest marker [px]
  /// @param min_contrast    white - black [DN]
  const Result& run(const AxisMap& map, const Frame& frame, double begin, double end, double max_motion,
                    double min_contrast);

 private:
  void readBand(const AxisMap& map, const Frame& frame, double begin, double end);
  Candidate bestAt(std::size_t place, double max_motion, double min_contrast) const;
  void keep(const Candidate& candidate);

  double begin_, end_;
  double first_ = 0;  ///< place of bin 0 along the axis [px]
  int reach_ = 0;     ///< half length of a profile
  double half_width_ = 0;
  std::vector<SearchTemplate> templates_;
  AxisProfile band_;
  AxisSamples samples_;
  std::vector<Candidate> best_;  ///< by place
  Result result_;
};

}  // namespace vibe::vision
