#pragma once

#include <array>
#include <cmath>

#include "track/blurred_line.hpp"

namespace vibe::vision {

/// The standard normal distribution as a table: its integral, itself and its density, to 1e-6. A step blurred by a
/// Gaussian of deviation s is value(x / s); the integral of that over x is s * integral(x / s).
class NormalTable {
 public:
  struct Entry {
    float integral, value, density;
  };
  static const NormalTable& instance();

  Entry at(float x) const {
    if (x <= -kReach) return {0, 0, 0};
    if (x >= kReach) return {x, 1, 0};
    const int i = static_cast<int>((x + kReach) * kPerUnit + 0.5F);
    const Entry& e = entries_[static_cast<std::size_t>(i)];
    const float centre = static_cast<float>(i) / kPerUnit - kReach, d = x - centre;
    const float slope = -centre * e.density, bend = (centre * centre - 1) * e.density;
    return {e.integral + d * (e.value + d * (0.5F * e.density + d * slope / 6)),
            e.value + d * (e.density + d * (0.5F * slope + d * bend / 6)), e.density + d * (slope + 0.5F * d * bend)};
  }

 private:
  NormalTable();
  static constexpr float kReach = 5, kPerUnit = 16;
  std::array<Entry, 161> entries_{};
};

/// Standard deviations of the blur after which an edge is over, and between cut and edge of a stripe from which they do
/// not disturb each other.
constexpr float kEdgeReach = 3.4F, kCornerReach = 3.1F;

/// A periodic stripe that stops at a straight cut across the axis, seen along one line parallel to the axis and blurred
/// in both directions. The two kinds of edges are not at right angles; where they meet, the picture is the mean over
/// the blur across the axis of pictures along it.
class CutStripe {
 public:
  /// @param period, black  of the stripe along the axis; one black part is centred on 0 [px]
  CutStripe(double period, double black, const BlurredLine& line);

  /// Integral of the blackness along the axis, blackness, its slope along the axis and the integral's derivative by a
  /// shift of the stripe against the cut.
  struct Entry {
    float integral, value, slope, by_shift;
  };
  /// @param y  place relative to the cut: the stripe is where y < 0 [px]
  /// @param phase  place of the cut in the stripe, from the centre of a black part [px]
  /// @param variance  of the blur along the axis, cut_variance: of phase, full_variance: of phase + y [px^2]
  Entry at(float y, float phase, float variance, float cut_variance, float full_variance) const;
  /// Distance along the axis from an edge of the stripe.
  float edgeDistance(float phase) const { return std::abs(std::abs(wrapped(phase)) - half_black_); }
  bool isBlack(float phase) const { return std::abs(wrapped(phase)) < half_black_; }

 private:
  /// Between -period / 2 and period / 2.
  float wrapped(float phase) const {
    const auto turns = static_cast<float>(static_cast<int>(phase * inverse_period_ + 1024.5F)) - 1024;
    return phase - period_ * turns;
  }
  float edgeBefore(float phase, bool black) const;
  Entry farFromEdges(float y, float phase, float deviation, float full_variance) const;
  Entry nearCut(float y, float phase, float deviation, float cut_deviation) const;

  const BlurredLine& line_;
  float period_, inverse_period_, half_black_, mean_;
};

}  // namespace vibe::vision
