#include <cmath>
#include <limits>

#include "arithmetic/double_double.hpp"
#include "arithmetic/elementary.hpp"

namespace vibe::math {

namespace {

__extension__ using Wide = unsigned __int128;

/// x = quadrant pi/2 + r modulo 2 pi, |r| <= pi/4 and a bit
struct Angle {
  Double2 r;
  int quadrant;  // its last two bits count
};

/// The bits of 2/pi behind the binary point, after 64 zeros.
constexpr std::uint64_t kTwoByPi[] = {0,
                                      0xa2f9836e4e441529,
                                      0xfc2757d1f534ddc0,
                                      0xdb6295993c439041,
                                      0xfe5163abdebbc561,
                                      0xb7246e3a424dd2e0,
                                      0x06492eea09d1921c,
                                      0xfe1deb1cb129a73e,
                                      0xe88235f52ebb4484,
                                      0xe99c7026b45f7e41,
                                      0x3991d639835339f4,
                                      0x9c845f8bbdf9283b,
                                      0x1ff897ffde05980f,
                                      0xef2f118b5a0a6d1f,
                                      0x6d367ecf27cb09b7,
                                      0x4f463f669e5fea2d,
                                      0x7527bac7ebe5f17b,
                                      0x3d0739f78a5292ea,
                                      0x6bfb5fb11f8d5d08,
                                      0x56033046fc7b6bab,
                                      0xf0cfbc209af4361d};

/// 64 bits of the above, from a bit on.
std::uint64_t bitsFrom(int bit) {
  const int word = bit / 64, shift = bit % 64;
  return shift == 0 ? kTwoByPi[word] : kTwoByPi[word] << shift | kTwoByPi[word + 1] >> (64 - shift);
}

/// x = m 2^e with an integer m. Bits of 2/pi whose product with x is a multiple of 4 do not matter; the next 192 bits
/// times m, modulo 2^192, are the quadrant (2 bits) and its fraction (190 bits, an error of 2^-137).
Angle reducedHugeByHalfPi(double x) {
  const std::uint64_t bits = bitsOf(x);
  const int e = static_cast<int>(bits >> 52 & 0x7ff) - 1075, first = 64 + e - 2;
  const std::uint64_t m = (bits & 0x000fffffffffffff) | 0x0010000000000000;
  const Wide low = static_cast<Wide>(m) * bitsFrom(first + 128);
  const Wide middle = static_cast<Wide>(m) * bitsFrom(first + 64) + static_cast<std::uint64_t>(low >> 64);
  const std::uint64_t high = m * bitsFrom(first) + static_cast<std::uint64_t>(middle >> 64);
  std::uint64_t fraction[3] = {high << 2 | static_cast<std::uint64_t>(middle) >> 62,
                               static_cast<std::uint64_t>(middle) << 2 | static_cast<std::uint64_t>(low) >> 62,
                               static_cast<std::uint64_t>(low) << 2};
  auto quadrant = static_cast<int>(high >> 62);
  const bool upper = fraction[0] >> 63 != 0;  // to the nearest quadrant: 1 - fraction, but for the last bit
  if (upper) {
    for (std::uint64_t& word : fraction) word = ~word;
    ++quadrant;
  }
  Double2 turn{0, 0};
  double unit = 1;
  for (const std::uint64_t word : fraction)
    for (int shift = 32; shift >= 0; shift -= 32) {
      unit *= 0x1p-32;
      const Double2 sum = exactSum(turn.high, static_cast<double>(word >> shift & 0xffffffff) * unit);
      turn = fastSum(sum.high, sum.low + turn.low);
    }
  if (upper != (x < 0)) turn = {-turn.high, -turn.low};
  const Double2 r = exactProduct(turn.high, kHalfPiHigh);
  return {fastSum(r.high, r.low + (turn.low * kHalfPiHigh + turn.high * kHalfPiLow)), x < 0 ? -quadrant : quadrant};
}

/// pi/2 in four parts, the first three of 33 bits: their products with the quadrant are exact.
Angle reducedByHalfPi(double x) {
  if (std::abs(x) < 0.785) return {{x, 0}, 0};
  if (std::abs(x) > 1.6e6) return reducedHugeByHalfPi(x);
  const Rounded n = nearest(x * 0x1.45f306dc9c883p-1);
  const Double2 a = exactSum(x - n.value * 0x1.921fb54400000p+0, -(n.value * 0x1.0b4611a600000p-34));
  const Double2 b = exactSum(a.high, -(n.value * 0x1.3198a2e000000p-69));
  return {fastSum(b.high, (a.low + b.low) - n.value * 0x1.b839a252049c1p-104), static_cast<int>(n.number)};
}

/// (sin(r) - r) / r, z = r^2
double sineTail(double z) {
  const double z2 = z * z;
  const double low = (-1.0 / 6 + z * (1.0 / 120)) + z2 * (-1.0 / 5040 + z * (1.0 / 362880));
  const double high =
      (-1.0 / 39916800 + z * (1.0 / 6227020800)) + z2 * (-1.0 / 1307674368000 + z * (1.0 / 355687428096000));
  return z * (low + z2 * z2 * high);
}

/// cos(r) - 1 + r^2 / 2, z = r^2
double cosineTail(double z) {
  const double z2 = z * z;
  const double low = (1.0 / 24 + z * (-1.0 / 720)) + z2 * (1.0 / 40320 + z * (-1.0 / 3628800));
  const double high =
      (1.0 / 479001600 + z * (-1.0 / 87178291200)) + z2 * (1.0 / 20922789888000 + z * (-1.0 / 6402373705728000));
  return z2 * (low + z2 * z2 * high);
}

Double2 sine(const Double2& r) {
  const double z = r.high * r.high;
  return fastSum(r.high, r.high * sineTail(z) + r.low * (1 - 0.5 * z));
}

Double2 cosine(const Double2& r) {
  const Double2 z = exactProduct(r.high, r.high), start = fastSum(1, -0.5 * z.high);
  return fastSum(start.high, start.low + (cosineTail(z.high) - (0.5 * z.low + r.high * r.low)));
}

double notANumber(double x) {
  return x - x;  // for infinity and NaN
}

/// The sine of an angle `quadrants` later.
double sineOf(double x, int quadrants) {
  const Angle angle = reducedByHalfPi(x);
  const int quadrant = angle.quadrant + quadrants;
  const double value = (quadrant & 1) == 0 ? sine(angle.r).high : cosine(angle.r).high;
  return (quadrant & 2) == 0 ? value : -value;
}

}  // namespace

double sin(double x) {
  if (!(std::abs(x) < std::numeric_limits<double>::infinity())) return notANumber(x);
  return std::abs(x) < 0x1p-27 ? x : sineOf(x, 0);
}

double cos(double x) {
  return std::abs(x) < std::numeric_limits<double>::infinity() ? sineOf(x, 1) : notANumber(x);
}

double tan(double x) {
  if (!(std::abs(x) < std::numeric_limits<double>::infinity())) return notANumber(x);
  if (std::abs(x) < 0x1p-27) return x;
  const Angle angle = reducedByHalfPi(x);
  const Double2 s = sine(angle.r), c = cosine(angle.r);
  return (angle.quadrant & 1) == 0 ? quotient(s, c).high : -quotient(c, s).high;
}

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
