// Numbers as text where the standard library has nothing for them, against the standard library.
#include "vibe_core/files/number_text.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <cstring>
#include <random>

#include "files/portable_numbers.hpp"

namespace vibe::number_text_test {
namespace {

void expectSame(const std::string& text) {
  double a = 7, b = 7;
  const char *const begin = text.data(), *const end = begin + text.size();
  const auto one = readReal(begin, end, a), other = portable::readReal(begin, end, b);
  EXPECT_EQ(one.ec, other.ec) << text;
  EXPECT_EQ(one.ptr - begin, other.ptr - begin) << text;
  EXPECT_EQ(std::memcmp(&a, &b, sizeof a), 0) << text << ": " << a << " and " << b;
}

TEST(NumberText, WordsAndEndsAreReadAlike) {
  for (const char* text :
       {"",     "-",   "+1",  " 1",        ".",        "-.",  ".5",   "5.",    "5.e3",    "1e",       "1e+",   "1e5x",
        "0x10", "1,5", "inf", "-Infinity", "infinite", "NaN", "-nan", "1e400", "-1e-400", "4.9e-324", "0e999", "--1"})
    expectSame(text);
}

TEST(NumberText, RandomNumbersAreReadAndWrittenAlike) {
  std::mt19937_64 random(5);
  for (int i = 0; i < 20000; ++i) {
    const std::uint64_t bits = random();
    double value = 0;
    std::memcpy(&value, &bits, sizeof value);
    if (!std::isfinite(value)) continue;
    const std::string text = shortestText(value), own = portable::shortestText(value);
    expectSame(text);
    expectSame(own);
    double back = 0;
    portable::readReal(own.data(), own.data() + own.size(), back);
    EXPECT_EQ(back, value) << own;
  }
}

}  // namespace
}  // namespace vibe::number_text_test
