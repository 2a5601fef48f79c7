#include "vibe_core/arithmetic/random.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace vibe::random_test {
namespace {

// The first numbers of the authors' reference implementation (splitmix64.c of Vigna, 2015) for the seed 1234567.
TEST(Random, IsTheReferenceStream) {
  std::uint64_t state = 1234567;
  for (const std::uint64_t expected : {6457827717110365317ULL, 3203168211198807973ULL, 9817491932198370423ULL,
                                       4593380528125082431ULL, 16408922859458223821ULL})
    EXPECT_EQ(nextInteger(state), expected);
  EXPECT_EQ(mixed(1234567), 6457827717110365317ULL);
}

TEST(Random, UniformNumbersAreTheUpperBitsOfTheIntegers) {
  std::uint64_t integers = 7, uniforms = 7;
  for (int k = 0; k < 100; ++k)
    EXPECT_EQ(nextUniform(uniforms), std::ldexp(static_cast<double>(nextInteger(integers) >> 11), -53));
  EXPECT_EQ(uniforms, integers);
}

// Mean 1/2 and variance 1/12 within four standard errors: sqrt(1/12 n) and sqrt(1/180 n).
TEST(Random, UniformNumbersAreUniform) {
  constexpr int kCount = 100000;
  std::uint64_t state = 1;
  double sum = 0, squares = 0;
  for (int k = 0; k < kCount; ++k) {
    const double x = nextUniform(state);
    ASSERT_GE(x, 0);
    ASSERT_LT(x, 1);
    sum += x - 0.5;
    squares += (x - 0.5) * (x - 0.5);
  }
  EXPECT_NEAR(sum / kCount, 0, 4 / std::sqrt(12.0 * kCount));
  EXPECT_NEAR(squares / kCount, 1.0 / 12, 4 / std::sqrt(180.0 * kCount));
}

}  // namespace
}  // namespace vibe::random_test
