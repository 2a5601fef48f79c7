#include <cmath>
#include <limits>

#include "arithmetic/double_double.hpp"
#include "arithmetic/elementary.hpp"

namespace vibe::math {

namespace {

/// x = exponent ln 2 + high + low, |high| <= ln(2) / 2 and a bit
struct Reduced {
  double high, low;
  int exponent;
};

Reduced reducedByLn2(double x) {
  const Rounded n = nearest(x * 0x1.71547652b82fep+0);
  const double start = x - n.value * kLn2High, rest = n.value * kLn2Low, high = start - rest;
  return {high, (start - high) - rest, static_cast<int>(n.number)};
}

/// exp(r) - 1 - r - r^2 / 2, |r| <= 0.35
double exponentialTail(double r) {
  const double r2 = r * r, r4 = r2 * r2;
  const double low = (1.0 / 6 + r * (1.0 / 24)) + r2 * (1.0 / 120 + r * (1.0 / 720));
  const double middle = (1.0 / 5040 + r * (1.0 / 40320)) + r2 * (1.0 / 362880 + r * (1.0 / 3628800));
  const double high = (1.0 / 39916800 + r * (1.0 / 479001600)) + r2 * (1.0 / 6227020800 + r * (1.0 / 87178291200));
  return r * r2 * (low + r4 * (middle + r4 * high));
}

/// x 2^k, in two steps where 2^k is no normal number
double timesPower(double x, int k) {
  if (k > -1022 && k < 1024) return x * powerOfTwo(k);
  return x * powerOfTwo(k / 2) * powerOfTwo(k - k / 2);
}

/// exp(x) - 1 = 2^exponent sum, -56 ln 2 < x < 1024 ln 2
struct Growth {
  Double2 sum;
  int exponent;
};

Growth growth(double x) {
  const Reduced r = reducedByLn2(x);
  const Double2 one = exactSum(1, r.exponent < 100 ? -powerOfTwo(-r.exponent) : 0);
  const double upper = split(r.high).high;  // its square has no rounding error
  const Double2 start = fastSum(one.high, r.high), next = fastSum(start.high, 0.5 * upper * upper);
  const double rest =
      one.low + 0.5 * (r.high - upper) * (r.high + upper) + (r.low * (1 + r.high) + exponentialTail(r.high));
  return {fastSum(next.high, next.low + (start.low + rest)), r.exponent};
}

}  // namespace

double exp(double x) {
  if (!(std::abs(x) < 708)) {
    if (std::isnan(x)) return x;
    if (x > 709.79) return std::numeric_limits<double>::infinity();
    if (x < -745.2) return 0;
  }
  const Reduced r = reducedByLn2(x);
  const Double2 start = fastSum(1, r.high);
  const double rest = 0.5 * r.high * r.high + exponentialTail(r.high);
  return timesPower(start.high + (start.low + (r.low * start.high + rest)), r.exponent);
}

double expm1(double x) {
  if (!(std::abs(x) < 38)) {
    if (std::isnan(x)) return x;
    if (x > 709.79) return std::numeric_limits<double>::infinity();
    if (x < -38) return -1;
  }
  if (std::abs(x) < 0x1p-54) return x;
  const Growth g = growth(x);
  return timesPower(g.sum.high, g.exponent);
}

double tanh(double x) {
  const double size = std::abs(x);
  if (size < 0x1p-28 || std::isnan(x)) return x;
  if (size > 22) return std::copysign(1.0, x);
  const Growth g = growth(2 * size);
  const double scale = powerOfTwo(g.exponent);
  const Double2 above = {g.sum.high * scale, g.sum.low * scale}, below = exactSum(above.high, 2);
  return std::copysign(quotient(above, {below.high, below.low + above.low}).high, x);
}

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

/// A guess by a third of the exponent (Kahan 1991, "Computing a real cube root"), two steps of Halley's method, and one
/// whose square and residual have no rounding error.
double cbrt(double x) {
  if (x == 0 || !(std::abs(x) < std::numeric_limits<double>::infinity())) return x;
  const bool tiny = std::abs(x) < std::numeric_limits<double>::min();
  const Scaled scaled = scaledToOne(tiny ? std::abs(x) * 0x1p54 : std::abs(x));
  const int third = (scaled.exponent + 1200) / 3 - 400;  // rounded down
  const double size = scaled.factor * powerOfTwo(scaled.exponent - 3 * third);
  double t = fromBits(bitsOf(size) / 3 + 0x2a9f789300000000);
  for (int step = 0; step < 2; ++step) {
    const double error = t * t * t - size;
    t -= t * error / (error + error + 3 * size);
  }
  t = fromBits((bitsOf(t) + 0x10000000) & 0xffffffffe0000000);  // to 24 bits
  const double ratio = size / (t * t);
  t += t * ((ratio - t) / (t + t + ratio));
  return std::copysign(t * powerOfTwo(tiny ? third - 18 : third), x);
}

double hypot(double x, double y) {
  const double a = std::abs(x), b = std::abs(y), greater = a > b ? a : b, smaller = a > b ? b : a;
  if (std::isinf(a) || std::isinf(b)) return std::numeric_limits<double>::infinity();
  if (std::isnan(a) || std::isnan(b)) return a + b;
  if (smaller <= greater * 0x1p-60) return greater + smaller;
  const double scale = greater > 0x1p500 ? 0x1p-600 : greater < 0x1p-400 ? 0x1p600 : 1;
  const Double2 p = exactProduct(greater * scale, greater * scale), q = exactProduct(smaller * scale, smaller * scale);
  const Double2 sum = fastSum(p.high, q.high);
  const double root = std::sqrt(sum.high);
  const Double2 back = exactProduct(root, root);
  return (root + (((sum.high - back.high) - back.low) + (sum.low + p.low + q.low)) / (2 * root)) / scale;
}

}  // namespace vibe::math
