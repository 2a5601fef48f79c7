#include <cmath>
#include <limits>

#include "common/double_double.hpp"
#include "common/elementary.hpp"

namespace vibe::math {

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
