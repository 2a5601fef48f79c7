#include <cmath>
#include <limits>

#include "common/double_double.hpp"
#include "common/elementary.hpp"

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

}  // namespace vibe::math
