#include "arithmetic/elementary.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <functional>
#include <limits>
#include <vector>

#include "vibe_core/arithmetic/random.hpp"

// References are the long double functions of the C library, whose 64 bits are enough to measure an error.

namespace vibe::elementary_test {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kNotANumber = std::numeric_limits<double>::quiet_NaN();
constexpr double kPi = 3.141592653589793;

struct Function {
  const char* name;
  double (*own)(double);
  long double (*exact)(long double);
  double (*library)(double);
  double low, high;  // of the arguments, besides those of every size
  double limit;      // of the error, in units in the last place; what was measured, rounded up
};

const std::vector<Function> kFunctions = {
    {"exp", math::exp, std::exp, std::exp, -1, 1, 0.65},
    {"expm1", math::expm1, std::expm1, std::expm1, -1, 1, 0.7},
    {"log", math::log, std::log, std::log, 0.5, 2, 0.7},
    {"log1p", math::log1p, std::log1p, std::log1p, -0.6, 1, 0.7},
    {"sin", math::sin, std::sin, std::sin, -10, 10, 0.85},
    {"cos", math::cos, std::cos, std::cos, -10, 10, 0.85},
    {"tan", math::tan, std::tan, std::tan, -10, 10, 0.95},
    {"acos", math::acos, std::acos, std::acos, -1, 1, 0.55},
    {"tanh", math::tanh, std::tanh, std::tanh, -2, 2, 0.65},
    {"asinh", math::asinh, std::asinh, std::asinh, -3, 3, 0.7},
    {"cbrt", math::cbrt, std::cbrt, std::cbrt, -8, 8, 0.7},
};

/// Distance from the exact value in units in the last place of the double nearest to it.
double unitsOff(double value, long double exact) {
  const auto rounded = static_cast<double>(exact);
  if (std::isnan(rounded)) return std::isnan(value) ? 0 : kInfinity;
  if (std::isinf(rounded) || rounded == 0)
    return value == rounded && std::signbit(value) == std::signbit(rounded) ? 0 : kInfinity;
  int exponent;
  std::frexp(rounded, &exponent);
  const long double unit = std::ldexp(1.0L, std::max(exponent, -1021) - 53);
  return static_cast<double>(std::abs((static_cast<long double>(value) - exact) / unit));
}

/// Doubles of every exponent and sign.
double anyDouble(std::uint64_t& state) {
  double x;
  do {
    const std::uint64_t bits = nextInteger(state);
    std::memcpy(&x, &bits, sizeof x);
  } while (!std::isfinite(x));
  return x;
}

std::vector<double> specialArguments() {
  std::vector<double> values;
  for (const double x : {0.0,
                         1.0,
                         0.5,
                         2.0,
                         kInfinity,
                         kNotANumber,
                         std::numeric_limits<double>::min(),
                         std::numeric_limits<double>::denorm_min(),
                         std::numeric_limits<double>::max(),
                         1e-300,
                         1e300,
                         1e-17,
                         1e-9,
                         708.0,
                         709.7827,
                         709.783,
                         745.1,
                         745.2,
                         38.0,
                         22.0,
                         0.785,
                         1.6e6,
                         1e22,
                         6381956970095103.0 * 0x1p797 /* 2^-61 from a multiple of pi/2 */})
    for (const double near : {x, std::nextafter(x, 0), std::nextafter(x, kInfinity)})
      for (const double signed_one : {near, -near}) values.push_back(signed_one);
  for (int n = 1; n < 2000; ++n)
    for (const double x : {n * kPi / 2, n * n * kPi / 2, std::nextafter(n * kPi / 2, 0), std::pow(2.0, n % 1000) * kPi})
      values.push_back(x);
  return values;
}

double largestError(const Function& f) {
  double max = 0;
  const auto look = [&](double x) {
    const double off = unitsOff(f.own(x), f.exact(x));
    if (off > f.limit) ADD_FAILURE() << f.name << "(" << std::hexfloat << x << ") is " << off << " units off";
    max = std::max(max, off);
  };
  for (const double x : specialArguments()) look(x);
  std::uint64_t state = 5;
  for (int i = 0; i < 300000; ++i) look(f.low + (f.high - f.low) * nextUniform(state));
  for (int i = 0; i < 50000; ++i) look(anyDouble(state)), look((1 - 2 * nextUniform(state)) * 700);
  return max;
}

TEST(Elementary, ErrorsAreBelowOneUnit) {
  for (const Function& f : kFunctions) {
    const double max = largestError(f);
    RecordProperty(f.name, std::to_string(max));
    std::printf("%6s: at most %.3f units in the last place\n", f.name, max);
    EXPECT_GT(max, 0.49) << "the measurement sees rounding errors";
  }
}

TEST(Elementary, FunctionsOfTwoNumbersHaveErrorsBelowOneUnit) {
  std::uint64_t state = 6;
  double angle = 0, length = 0;
  const auto look = [&](double y, double x) {
    angle = std::max(angle,
                     unitsOff(math::atan2(y, x), std::atan2(static_cast<long double>(y), static_cast<long double>(x))));
    length = std::max(
        length, unitsOff(math::hypot(y, x), std::hypot(static_cast<long double>(y), static_cast<long double>(x))));
  };
  for (const double y : {0.0, 1.0, kInfinity, kNotANumber, 1e-320, 1e-300, 1e300, 1.7e308})
    for (const double x : {0.0, 1.0, kInfinity, kNotANumber, 1e-320, 1e-300, 1e300, 1.7e308})
      look(y, x), look(-y, x), look(y, -x), look(-y, -x);
  for (int i = 0; i < 300000; ++i) look(nextUniform(state) - 0.5, nextUniform(state) - 0.5);
  for (int i = 0; i < 100000; ++i) look(anyDouble(state), anyDouble(state));
  std::printf(" atan2: at most %.3f units in the last place\n hypot: at most %.3f\n", angle, length);
  EXPECT_LT(angle, 0.6);
  EXPECT_LT(length, 0.6);
}

TEST(Elementary, MeasurementNoticesTheLastBit) {
  const Function& f = kFunctions[0];
  double max = 0;
  for (double x = 0; x < 1; x += 1e-4) max = std::max(max, unitsOff(std::nextafter(f.own(x), kInfinity), f.exact(x)));
  EXPECT_GT(max, 1) << "a result one unit too large is noticed";
}

/// The same bits with every compiler, processor and C library: a hash of many results, from a machine with g++ 12.
TEST(Elementary, BitsAreThoseOfEveryBuild) {
  std::uint64_t hash = 0xcbf29ce484222325;
  const auto add = [&](double x) {
    std::uint64_t bits;
    std::memcpy(&bits, &x, sizeof bits);
    hash = (hash ^ (std::isnan(x) ? 1 : bits)) * 0x100000001b3;
  };
  std::uint64_t state = 7;
  for (int i = 0; i < 20000; ++i) {
    const double u = nextUniform(state);
    for (const Function& f : kFunctions) add(f.own(f.low + (f.high - f.low) * u)), add(f.own(anyDouble(state)));
    const double y = anyDouble(state), x = anyDouble(state);
    add(math::atan2(u - 0.5, 0.3)), add(math::hypot(u, 0.3)), add(math::atan2(y, x)), add(math::hypot(y, x));
  }
  EXPECT_EQ(hash, 123714401944823175U);
}

}  // namespace
}  // namespace vibe::elementary_test
