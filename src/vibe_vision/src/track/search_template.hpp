#pragma once
#include <Eigen/Core>
#include <array>
#include <vector>

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
  Match match(const AxisSamples& samples, std::size_t place) const;

 private:
  Match describe(const Eigen::Vector3d& parts, double explained, double spread) const;
  Match matchPart(const AxisSamples& samples, std::size_t begin) const;

  double motion_, scale_;
  int half_ = 0, count_ = 1;                           ///< profiles
  std::array<std::vector<float>, 3> profiles_;         ///< of mean 0, filled up with zeros
  Eigen::Matrix3d inverse_ = Eigen::Matrix3d::Zero();  ///< of the profiles' products
};

}  // namespace vibe::vision
