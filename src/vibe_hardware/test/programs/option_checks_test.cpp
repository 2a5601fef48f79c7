// What the programs accept for numbers on the command line.
#include "option_checks.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace vibe::hardware::option_checks_test {
namespace {

/// What a program with these checks says to its arguments.
std::string errorOf(std::vector<std::string> arguments) {
  CLI::App app;
  double duration = 0;
  std::uint64_t seed = 0;
  app.add_option("--duration", duration)->check(notNegative());
  app.add_option("--seed", seed)->check(wholeNumber());
  std::reverse(arguments.begin(), arguments.end());  // as CLI11 wants them
  try {
    app.parse(arguments);
  } catch (const CLI::ParseError& error) {
    return error.what();
  }
  return "";
}

TEST(OptionChecks, NotNegativeTakesFiniteNumbersOfAtLeastZero) {
  for (const char* number : {"0", "2", "0.5", "1e-3"}) EXPECT_EQ(errorOf({"--duration", number}), "");
  for (const std::string text : {"-1", "abc", "nan", "inf", "1s"})
    EXPECT_EQ(errorOf({"--duration", text}), "--duration: '" + text + "' is not a number of at least 0");
}

TEST(OptionChecks, WholeNumberTakesTheDigitsOfAnUnsignedNumber) {
  for (const char* number : {"0", "7", "18446744073709551615"}) EXPECT_EQ(errorOf({"--seed", number}), "");
  for (const std::string text : {"-1", "abc", "1.5", "1e3", "0x10", "3 4"})
    EXPECT_EQ(errorOf({"--seed", text}), "--seed: '" + text + "' is not a whole number of at least 0");
  EXPECT_EQ(errorOf({"--seed", "18446744073709551616"}),
            "--seed: '18446744073709551616' is too large; write at most 18446744073709551615");
}

}  // namespace
}  // namespace vibe::hardware::option_checks_test
