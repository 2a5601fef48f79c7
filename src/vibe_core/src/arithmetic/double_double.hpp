#pragma once

#include <cstdint>
#include <cstring>

/// Sums and products of doubles without error, for elementary functions. Needs rounding to nearest and no contraction.
namespace vibe::math {

/// A number in two parts: the second is at most half a unit in the last place of the first.
struct Double2 {
  double high, low;
};

/// a + b; |a| >= |b| or a = 0 (Dekker 1971)
inline Double2 fastSum(double a, double b) {
  const double sum = a + b;
  return {sum, (a - sum) + b};
}

/// a + b (Knuth, "The art of computer programming", volume 2, section 4.2.2, theorem B)
inline Double2 exactSum(double a, double b) {
  const double sum = a + b, part = sum - a;
  return {sum, (a - (sum - part)) + (b - part)};
}

/// The upper 26 bits of a, and the rest (Veltkamp 1968); |a| < 2^996
inline Double2 split(double a) {
  const double scaled = 134217729.0 * a, high = scaled - (scaled - a);
  return {high, a - high};
}

/// a b, unless it is below 2^-969 or so (Dekker 1971)
inline Double2 exactProduct(double a, double b) {
  const double product = a * b;
  const Double2 x = split(a), y = split(b);
  return {product, ((x.high * y.high - product) + x.high * y.low + x.low * y.high) + x.low * y.low};
}

/// a / b, relative error about 2^-100
inline Double2 quotient(const Double2& a, const Double2& b) {
  const double ratio = a.high / b.high;
  const Double2 back = exactProduct(ratio, b.high);
  return fastSum(ratio, (((a.high - back.high) - back.low) + a.low - ratio * b.low) / b.high);
}

inline std::uint64_t bitsOf(double x) {
  std::uint64_t bits;
  std::memcpy(&bits, &x, sizeof bits);
  return bits;
}

inline double fromBits(std::uint64_t bits) {
  double x;
  std::memcpy(&x, &bits, sizeof x);
  return x;
}

/// 2^k, -1022 <= k <= 1023
inline double powerOfTwo(int k) {
  return fromBits(static_cast<std::uint64_t>(k + 1023) << 52);
}

/// The nearest integer, |x| < 2^51. `number` is its last bits, for any such x.
struct Rounded {
  double value;
  std::int64_t number;
};
inline Rounded nearest(double x) {
  constexpr double kShift = 0x1.8p52;  // at this size a double has no fractional bits
  const double shifted = x + kShift;
  return {shifted - kShift, static_cast<std::int64_t>(bitsOf(shifted) - bitsOf(kShift))};
}

/// x = factor * 2^exponent with a factor in [sqrt(1/2), sqrt(2)); x is positive and normal
struct Scaled {
  double factor;
  int exponent;
};
inline Scaled scaledToOne(double x) {
  constexpr std::uint64_t kRootHalf = 0x3fe6a09e667f3bcd;
  const std::uint64_t bits = bitsOf(x) - kRootHalf;
  const auto exponent = static_cast<int>(static_cast<std::int64_t>(bits) >> 52);
  return {fromBits((bits & 0x000fffffffffffff) + kRootHalf), exponent};
}

/// ln 2; 38 bits and the rest: the product of the first part and an exponent is exact
constexpr double kLn2High = 0x1.62e42fefa0000p-1, kLn2Low = 0x1.cf79abc9e3b3ap-40;
/// pi / 2
constexpr double kHalfPiHigh = 0x1.921fb54442d18p+0, kHalfPiLow = 0x1.1a62633145c07p-54;

}  // namespace vibe::math
