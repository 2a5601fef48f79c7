#include <cmath>
#include <limits>

#include "common/double_double.hpp"
#include "common/elementary.hpp"

namespace vibe::math {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// The terms of log((1 + s) / (1 - s)) / s from the second on, of z = s^2 <= 0.0295
double logarithmTail(double z) {
  const double z2 = z * z, z4 = z2 * z2;
  const double low = (2.0 / 3 + z * (2.0 / 5)) + z2 * (2.0 / 7 + z * (2.0 / 9));
  const double middle = (2.0 / 11 + z * (2.0 / 13)) + z2 * (2.0 / 15 + z * (2.0 / 17));
  const double high = (2.0 / 19 + z * (2.0 / 21)) + z2 * (2.0 / 23);
  return z * (low + z4 * (middle + z4 * high));
}

/// log(x 2^more); x.high is positive and normal. With f = m - 1 for x = m 2^k and s = f / (2 + f), log(1 + f) is f -
/// f^2/2 + s (f^2/2 + logarithmTail). f^2/2 is formed from the upper half of f without error.
double logOf(const Double2& x, int more = 0) {
  const Scaled m = scaledToOne(x.high);
  const double f = m.factor - 1, upper = split(f).high, half = 0.5 * upper * upper;
  const double rest = 0.5 * (f - upper) * (f + upper), s = f / (2 + f), k = m.exponent + more;
  const Double2 start = fastSum(f, -half), sum = exactSum(k * kLn2High, start.high);
  const double added = x.low == 0 ? 0 : x.low / x.high;
  return sum.high +
         (sum.low + (k * kLn2Low + (start.low + (added + (s * (half + rest + logarithmTail(s * s)) - rest)))));
}

}  // namespace

double log(double x) {
  if (!(x >= std::numeric_limits<double>::min() && x < kInfinity)) {
    if (x == 0) return -kInfinity;
    if (!(x > 0)) return std::numeric_limits<double>::quiet_NaN();
    return x == kInfinity ? x : logOf({x * 0x1p54, 0}, -54);
  }
  return logOf({x, 0});
}

double log1p(double x) {
  if (std::abs(x) < 0x1p-54 || x == kInfinity || std::isnan(x)) return x;
  if (x <= -1) return x == -1 ? -kInfinity : std::numeric_limits<double>::quiet_NaN();
  return logOf(exactSum(1, x));
}

/// log(1 + y) for y = x + x^2 / (1 + sqrt(1 + x^2))
double asinh(double x) {
  const double size = std::abs(x);
  if (size < 0x1p-28 || !(size < kInfinity)) return x;
  if (size > 0x1p28) return std::copysign(logOf({size, 0}, 1), x);
  const Double2 square = exactProduct(size, size), sum = exactSum(1, square.high);
  const double root = std::sqrt(sum.high);
  const Double2 back = exactProduct(root, root);
  const double more = (((sum.high - back.high) - back.low) + sum.low + square.low) / (2 * root);
  const Double2 below = exactSum(root, 1), part = quotient(square, {below.high, below.low + more});
  const Double2 y = exactSum(size, part.high), all = exactSum(1, y.high);
  return std::copysign(logOf({all.high, all.low + (y.low + part.low)}), x);
}

}  // namespace vibe::math
