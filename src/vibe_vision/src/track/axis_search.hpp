#pragma once

#include <array>
#include <vector>

#include <Eigen/Core>

#include "track/axis_map.hpp"
#include "vibe_vision/track/marker_pattern.hpp"

namespace vibe::vision {

/// Mean grey values along an axis, 1 px apart, with running sums.
class AxisSamples {
 public:
  static constexpr std::size_t kSpare = 8;  ///< readable values after the last

  explicit AxisSamples(std::size_t size);
  /// @param i  must grow from call to call. @param value  negative: not seen
  void set(std::size_t i, float value);

  std::size_t size() const { return seen_.size() - 1; }
  const float* data() const { return values_.data(); }
  bool isSeen(std::size_t i) const { return seen_[i + 1] > seen_[i]; }
  int seen(std::size_t begin, std::size_t end) const { return seen_[end] - seen_[begin]; }
  double sum(std::size_t begin, std::size_t end) const { return sum_[end] - sum_[begin]; }
  double squares(std::size_t begin, std::size_t end) const { return squares_[end] - squares_[begin]; }

 private:
  std::vector<float> values_;  ///< 0 where nothing is seen
  std::vector<int> seen_;
  std::vector<double> sum_, squares_;
};

/// How a marker looks along the axis at one scale and motion: constant + contrast * profile, to which its rotation adds
/// any multiple of two more profiles.
class SearchTemplate {
 public:
  SearchTemplate(const MarkerPattern& pattern, double motion, double scale);

  double motion() const { return motion_; }
  double scale() const { return scale_; }
  int half() const { return half_; }

  struct Match {
    double correlation = 0;  ///< multiple correlation coefficient
    double contrast = 0;
    double turn = 0;      ///< size of what the rotation adds, relative to the contrast
    double rotation = 0;  ///< [rad]
  };
  /// @param place  of the middle. All under the template must be within the samples; at least half must be seen
  /// @param least  correlation: below it, there is no match
  Match match(const AxisSamples& samples, std::size_t place, double least = 0) const;

 private:
  Match describe(const Eigen::Vector3d& parts, double explained, double spread, double least) const;
  Match matchPart(const AxisSamples& samples, std::size_t begin, double least) const;

  double motion_, scale_;
  int half_ = 0, count_ = 1;                           ///< profiles
  std::array<std::vector<float>, 3> profiles_;         ///< of mean 0, filled up with zeros
  Eigen::Matrix3d inverse_ = Eigen::Matrix3d::Zero();  ///< of the profiles' products
};

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
