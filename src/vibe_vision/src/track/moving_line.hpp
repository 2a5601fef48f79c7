#pragma once
#include <vector>

#include "track/blurred_line.hpp"

namespace vibe::vision {

/// Means of a BlurredLine over one motion, as tables for a few variances of the blur.
class MovingLine {
 public:
  static constexpr float kMaxHalfMotion = 24;  ///< [px]
  static constexpr std::size_t kPart = 64;

  /// @param levels  tables at most, >= 2
  MovingLine(const BlurredLine& line, int levels);

  /// Makes the tables: variances evenly from `low` to `high` [px^2], for a motion of 2 half_motion [px]. No allocation.
  void compose(float low, float high, float half_motion);

  /// Blackness, slope and second derivative at places x. Variance and half motion may differ from those of the tables,
  /// which corrects to first order.
  /// @param count  a multiple of 4, at most kPart
  struct Places {
    const float *x, *variance, *half_motion;
  };
  struct Result {
    float *value, *slope, *bend;
  };
  void look(const Places& places, std::size_t count, const Result& result) const;

 private:
  void composeLevel(float variance, float* table) const;

  const BlurredLine& line_;
  int max_levels_, levels_ = 2;
  std::size_t size_;  ///< entries of a level
  float low_ = 0, step_ = 1, half_motion_ = 0;
  std::vector<float> table_;  ///< value, slope, second derivative, 0
};

}  // namespace vibe::vision
