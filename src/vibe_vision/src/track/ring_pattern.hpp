#pragma once

#include <vector>

#include "vibe_vision/track/marker_pattern.hpp"

namespace vibe::vision {

/// Picture of a black ring on white, blurred, as a table over one quadrant: rows along the axis (u), columns across it
/// (v), kStep apart, beginning kMargin steps before the centre. It holds coefficients of a cubic B-spline (Unser,
/// Aldroubi, Eden, "B-spline signal processing", IEEE Trans. Signal Processing 41, 1993).
class RingTable {
 public:
  static constexpr double kStep = 0.5;  ///< [px]
  static constexpr int kMargin = 3;
  static constexpr double kMinBlur = 0.28;  ///< a pixel without optics has 0.29 px
  static constexpr double kMaxBlur = 4;     ///< [px]

  /// Radii, and extent of the table from the centre [px].
  RingTable(double inner, double outer, double reach_u, double reach_v, double max_motion);

  /// Makes the table for a blur (standard deviation, with the pixel's own) and a motion along u [px].
  void compose(double blur, double motion);

  const float* row(int u) const { return table_.data() + u * columns_; }
  int stride() const { return columns_; }
  /// Of the composed table: beyond, all is white.
  int rows() const { return used_rows_; }
  int columns() const { return used_columns_; }
  double blur() const { return blur_; }  ///< of the composed table

 private:
  struct Level {
    double blur = 0;
    std::vector<float> integral;  ///< over u from the centre, as coefficients, by rows of u
  };
  void buildLevel(Level& level) const;
  std::vector<double> radialProfile(double blur) const;
  void prefilterIntegral(std::vector<float>& integral) const;
  void mixLevels(int rows);
  void spreadMotion();

  double inner_, outer_, max_motion_;
  int rows_ = 0, columns_ = 0, integral_rows_ = 0;  ///< that there is room for
  int used_rows_ = 0, used_columns_ = 0;
  double blur_ = 0, motion_ = 0;
  std::vector<Level> levels_;
  std::vector<float> mixed_;  ///< integral at the blur asked for
  std::vector<float> table_;
};

/// A flat black ring on white.
class RingPattern : public MarkerPattern {
 public:
  RingPattern(const RingDesign& design, double pixels_per_metre);

  std::array<bool, kPoseParameters> observes() const override;
  Eigen::Vector2d window(const MarkerPose& pose, double motion) const override;
  Eigen::Vector2d maxWindow() const override { return Eigen::Vector2d::Constant(half_side_ * kMaxScale); }
  double rim() const override { return outer_; }
  void prepare(const MarkerPose& pose, const MarkerMotion& motion, bool rough = false) override;
  void evaluate(const MarkerPose& pose, const PixelBlock& pixels, PatternValues& values) override;
  void select(const MarkerPose& pose, double motion, PixelBlock& pixels) const override;
  double searchHalfWidth() const override { return 0.5 * outer_; }
  void searchProfile(double motion, double scale, std::vector<float>& profile) const override;

 private:
  /// The table's place and its value and derivatives there, for each pixel of a part of the block.
  struct Part;
  void place(const MarkerPose& pose, const PixelBlock& pixels, std::size_t begin, Part& part) const;
  void readTable(Part& part) const;
  void chain(const MarkerPose& pose, std::size_t begin, const Part& part, PatternValues& values) const;

  static constexpr double kMaxScale = 1.3;  ///< of the marker's size
  double inner_, outer_, half_side_;        ///< [px]
  RingTable table_;
};

}  // namespace vibe::vision
