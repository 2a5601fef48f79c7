#pragma once

namespace vibe::vision {

/// Share of an aperture of width `width` that lies on the positive side of an edge across it, at distance `distance`.
inline float edgeShare(float distance, float inverse_width) {
  const float share = 0.5F + distance * inverse_width;
  return share < 0.0F ? 0.0F : (share > 1.0F ? 1.0F : share);
}

/// The directions in which a function changes over a square aperture: by `wide` and `narrow` from side to side.
struct ApertureSpread {
  float wide, narrow;
};

/// @param x, y  change of a function over the aperture in both directions
inline ApertureSpread apertureSpread(float x, float y) {
  const float a = x < 0 ? -x : x, b = y < 0 ? -y : y;
  const float wide = a > b ? a : b, narrow = a > b ? b : a, least = 0.05F * wide;
  return {wide, narrow < least ? least : narrow};
}

/// Share of a square aperture where a linear function is positive; `value` in its middle. Exact: the value in a square
/// is distributed as the sum of two uniform ones.
inline float positiveShare(float value, const ApertureSpread& spread) {
  const auto square = [](float t) { return t > 0 ? t * t : 0.0F; };
  const float outer = (spread.wide + spread.narrow) / 2, inner = (spread.wide - spread.narrow) / 2;
  const float area = square(value + outer) - square(value + inner) - square(value - inner) + square(value - outer);
  const float share = area / (2 * spread.wide * spread.narrow);
  return share > 1 ? 1.0F : (share < 0 ? 0.0F : share);  // rounding
}

}  // namespace vibe::vision
