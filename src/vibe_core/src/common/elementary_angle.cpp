#include <cmath>
#include <limits>
#include <utility>

#include "common/double_double.hpp"
#include "common/elementary.hpp"

namespace vibe::math {
namespace {

constexpr double kPiHigh = 2 * kHalfPiHigh, kPiLow = 2 * kHalfPiLow;

/// atan(i / 8)
constexpr Double2 kArc[] = {{0, 0},
                            {0x1.fd5ba9aac2f6ep-4, -0x1.cd37686760c17p-59},
                            {0x1.f5b75f92c80ddp-3, 0x1.8ab6e3cf7afbdp-57},
                            {0x1.6f61941e4def1p-2, -0x1.c63aae6f6e918p-56},
                            {0x1.dac670561bb4fp-2, 0x1.a2b7f222f65e2p-56},
                            {0x1.1e00babdefeb4p-1, -0x1.928df287a668fp-58},
                            {0x1.4978fa3269ee1p-1, 0x1.2419a87f2a458p-56},
                            {0x1.700a7c5784634p-1, -0x1.8c34d25aadef6p-56},
                            {0x1.921fb54442d18p-1, 0x1.1a62633145c07p-55}};

/// (atan(t) - t) / t, z = t^2 <= 1/256
double arctangentTail(double z) {
  const double z2 = z * z;
  return z * (((-1.0 / 3 + z * (1.0 / 5)) + z2 * (-1.0 / 7 + z * (1.0 / 9))) +
              z2 * z2 * ((-1.0 / 11 + z * (1.0 / 13)) + z2 * (-1.0 / 15)));
}

/// atan(a / b), 0 <= a <= b: with c = i / 8 next to a / b it is atan(c) + atan((a - c b) / (b + c a)).
Double2 octant(const Double2& a, const Double2& b) {
  const Rounded i = nearest(8 * (a.high / b.high));
  const double c = i.value / 8;
  const Double2 part = exactProduct(c, b.high), more = exactProduct(c, a.high), below = exactSum(b.high, more.high);
  const Double2 above = exactSum(a.high, -part.high);
  const Double2 t = quotient({above.high, above.low - part.low + (a.low - c * b.low)},
                             {below.high, below.low + more.low + (b.low + c * a.low)});
  const Double2 arc = kArc[i.number], sum = fastSum(arc.high, t.high);
  return fastSum(sum.high, sum.low + (t.low + arc.low + t.high * arctangentTail(t.high * t.high)));
}

Double2 minus(double high, double low, const Double2& x) {
  const Double2 sum = fastSum(high, -x.high);
  return fastSum(sum.high, sum.low + (low - x.low));
}

/// The angle between the first axis and (x, y), y >= 0, not both 0; from 0 to pi
double angleOf(const Double2& y, const Double2& x) {
  const Double2 size = std::signbit(x.high) ? Double2{-x.high, -x.low} : x;
  Double2 angle = y.high > size.high ? minus(kHalfPiHigh, kHalfPiLow, octant(size, y)) : octant(y, size);
  if (std::signbit(x.high)) angle = minus(kPiHigh, kPiLow, angle);
  return angle.high;
}

}  // namespace

double acos(double x) {
  if (!(std::abs(x) < 1)) return x == 1 ? 0 : x == -1 ? kPiHigh : std::numeric_limits<double>::quiet_NaN();
  const Double2 square = exactProduct(x, x), rest = exactSum(1, -square.high);
  const double left = rest.low - square.low, root = std::sqrt(rest.high);
  const Double2 back = exactProduct(root, root);
  return angleOf({root, (((rest.high - back.high) - back.low) + left) / (2 * root)}, {x, 0});
}

double atan2(double y, double x) {
  if (std::isnan(x) || std::isnan(y)) return x + y;
  double a = std::abs(y), b = std::abs(x);
  if (std::isinf(x) || std::isinf(y)) a = std::isinf(y) ? 1 : 0, b = std::isinf(x) ? 1 : 0;
  if (a == 0) return std::copysign(std::signbit(x) ? kPiHigh : 0.0, y);
  if (!std::signbit(x) && a < 0x1p-30 * b) return std::copysign(a / b, y);
  const double greater = a > b ? a : b, scale = greater > 0x1p500 ? 0x1p-600 : greater < 0x1p-400 ? 0x1p600 : 1;
  return std::copysign(angleOf({a * scale, 0}, {std::copysign(b, x) * scale, 0}), y);
}

}  // namespace vibe::math
