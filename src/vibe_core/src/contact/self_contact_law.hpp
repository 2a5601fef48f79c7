#pragma once

#include <algorithm>
#include <cmath>

#include "common/elementary.hpp"

namespace vibe {

constexpr double kContactOnset = 0.25;  ///< strain over which contact of walls sets in [1]

/// Of a wall that is squeezed to s of its thickness, per A E' t / 2.
struct Squeeze {
  double value, slope, curvature;  // energy and its derivatives with respect to s [1]
};

/// Hencky's bar (see SelfContact); it sets in smoothly over kContactOnset on both sides of s = 1.
/// @param straight_below  extended linearly there
inline Squeeze squeeze(double s, double straight_below) {
  if (s >= 1 + kContactOnset) return {0, 0, 0};
  const double kept = std::max(s, straight_below), strain = 1 - kept;
  const double ramp = strain + kContactOnset;
  const bool full = strain > kContactOnset;
  const double h = full ? strain : ramp * ramp / (4 * kContactOnset);
  const double h_slope = full ? 1 : ramp / (2 * kContactOnset), h_curvature = full ? 0 : 1 / (2 * kContactOnset);
  const double hencky = math::log1p(-h), stress = hencky / (1 - h);
  const double slope = stress * h_slope;
  const double curvature = (1 - hencky) / ((1 - h) * (1 - h)) * h_slope * h_slope - stress * h_curvature;
  return {0.5 * hencky * hencky + slope * (s - kept), slope, curvature};
}

/// Smoothed Coulomb friction: potential per friction force and its derivative over the way slid, both as functions of
/// that way (Li et al. 2020, "Incremental Potential Contact", section 5.2, f_0 and f_1 / |u|).
struct Sliding {
  double way, per_way;  // [m], [1/m]
};
inline Sliding sliding(double way, double smooth) {
  if (way >= smooth) return {way - smooth / 3, 1 / way};
  return {way * way / smooth * (1 - way / (3 * smooth)), (2 - way / smooth) / smooth};
}

}  // namespace vibe
