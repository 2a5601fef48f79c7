#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <vector>

namespace vibe::vision {

/// Black from `begin` to `end` [px].
struct Interval {
  double begin = 0, end = 0;
};

/// Black intervals on a line, or once in every period of it, blurred by Gaussians of many variances: tables of the
/// blackness, its integral along the line and its derivatives. The mean of the blackness over a motion is a difference
/// of two integrals, so that tables serve every motion.
class BlurredLine {
 public:
  /// At one place: integral of the blackness from the left end (of a periodic line: less its mean), blackness, slope,
  /// second derivative.
  struct Entry {
    float integral, value, slope, bend;
  };
  static constexpr float kMaxVariance = 25;  ///< [px^2]
  static constexpr float kReach = 6;         ///< standard deviations after which an edge is over

  /// @param period  0: none
  /// @param min_variance  the smallest one that is asked for [px^2]
  /// @param pixel_variance  part of the variance that is the area of a pixel, uniform and not Gaussian [px^2]
  BlurredLine(const std::vector<Interval>& black, double period, double min_variance, double pixel_variance);

  float mean() const { return mean_; }      ///< blackness of a periodic line
  float length() const { return length_; }  ///< of a period, or of what has tables [px]
  /// From which on there is nothing, before and behind a line that is not periodic: [px] from the ends of its tables.
  float margin(float variance) const {
    return period_ > 0 ? 0 : kReach * (std::sqrt(kMaxVariance) - std::sqrt(variance));
  }

  struct Level {
    std::size_t first;  ///< entry
    float variance;
  };
  /// The tables for the variance nearest to one.
  Level levelOf(float variance) const {
    std::int32_t step = stepOf(variance);
    step = step < first_step_ ? first_step_ : (step > last_step_ ? last_step_ : step);
    return {static_cast<std::size_t>(step - first_step_) * size_, varianceOf(step)};
  }
  static constexpr float kPerPixel = 8;
  /// Entry at a place, counted from the beginning of the line or period, kPerPixel of them per pixel; to
  /// kMargin before and behind a period.
  const float* entry(const Level& level, int place) const {
    place += margin_;
    place = place < 0 ? 0 : (place > last_ ? last_ : place);
    return &entries_[level.first + static_cast<std::size_t>(place)].integral;
  }
  bool has(int place) const { return place + margin_ >= 0 && place + margin_ <= last_; }
  static constexpr int kMargin = 26;  ///< [px]
  /// Distance from the beginning of the line or period.
  struct Wrap {
    float begin, period, inverse_period;
    float at(float x) const {
      const float place = x - begin;
      return place - period * (static_cast<float>(static_cast<int>(place * inverse_period + kAboveZero)) - kAboveZero);
    }
  };
  Wrap wrap() const { return {begin_, period_, inverse_period_}; }

  Entry at(float x, float variance) const { return at(levelOf(variance), x, variance); }
  Entry at(const Level& level, float x, float variance) const {
    float place = wrap().at(x) * kPerPixel + static_cast<float>(margin_);
    place = place < 0 ? 0 : (place > static_cast<float>(last_) ? static_cast<float>(last_) : place);
    const int i = static_cast<int>(place + 0.5F);
    const Entry& e = entries_[level.first + static_cast<std::size_t>(i)];
    const float d = (place - static_cast<float>(i)) / kPerPixel, dv = variance - level.variance;
    const float s = 0.5F * (dv + d * d);  // heat equation: the derivative by the variance is half the second by x
    return {e.integral + d * (e.value - mean_) + s * e.slope + d * (s + dv) * e.bend / 3,
            e.value + d * e.slope + s * e.bend, e.slope + d * e.bend, e.bend};
  }

 private:
  static constexpr float kAboveZero = 4096;  // conversion to int rounds towards 0: keep it positive
  static constexpr int kShift = 20;  // bits of a float below the three highest of the mantissa: 8 levels per octave

  static std::int32_t stepOf(float variance) {
    std::int32_t bits;
    std::memcpy(&bits, &variance, sizeof bits);
    return (bits + (1 << (kShift - 1))) >> kShift;
  }
  static float varianceOf(std::int32_t step) {
    const std::int32_t bits = step << kShift;
    float variance;
    std::memcpy(&variance, &bits, sizeof bits);
    return variance;
  }
  Entry entryAt(const std::vector<Interval>& black, double x, double variance, double pixel_variance) const;

  float begin_ = 0, period_ = 0, inverse_period_ = 0, length_ = 0, mean_ = 0;
  int margin_ = 0, last_ = 0;  ///< entries before the period; the last entry of a level
  std::size_t size_ = 0;       ///< entries of a level
  std::int32_t first_step_ = 0, last_step_ = 0;
  std::vector<Entry> entries_;
};

/// A motion as parts of equal duration and even speed: one, or four of an accelerated one.
struct MotionParts {
  int count = 1;
  std::array<float, 5> place{-1, 1};  ///< where the parts begin and end, in halves of the motion

  /// @param bend  MarkerMotion::bend in halves of the motion, below kMostBend
  explicit MotionParts(float bend);
  static constexpr float kMostBend = 0.2F;  ///< of a motion that does not turn back
};

/// Means of a BlurredLine over one motion, as tables for a few variances of the blur.
class MovingLine {
 public:
  static constexpr float kMaxHalfMotion = 24;  ///< [px]
  static constexpr std::size_t kPart = 64;

  /// @param levels  tables at most, >= 2
  MovingLine(const BlurredLine& line, int levels);

  /// Makes the tables: variances evenly from `low` to `high` [px^2], for a motion of 2 half_motion [px] in parts. No
  /// allocation.
  void compose(float low, float high, float half_motion, const MotionParts& parts);

  struct Places {
    const float *x, *variance, *half_motion;
  };
  struct Result {
    float *value, *slope, *bend;
  };
  /// Blackness, slope and second derivative at places x. Variance and half motion may differ from those of the tables,
  /// which corrects to first order.
  /// @param count  a multiple of 4, at most kPart
  void look(const Places& places, std::size_t count, const Result& result) const;

 private:
  void composeLevel(float variance, const MotionParts& parts, float* table) const;

  const BlurredLine& line_;
  int max_levels_, levels_ = 2;
  std::size_t size_;                  ///< entries of a level
  std::size_t first_ = 0, last_ = 0;  ///< entries; before and behind there is nothing
  float low_ = 0, step_ = 1, half_motion_ = 0;
  std::vector<float> table_;  ///< value, slope, second derivative, 0
};

}  // namespace vibe::vision
