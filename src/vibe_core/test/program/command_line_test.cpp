#include "vibe_core/program/command_line.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "vibe_core/program/error.hpp"

namespace vibe::command_line_test {
namespace {

/// A program with one option of each kind.
struct Program {
  int run(std::vector<const char*> words) {
    words.insert(words.begin(), "a_program");
    CommandLine line("Does nothing.", "a_program");
    line.option("--size", size, "a number").typeName("N").check(finiteFrom(0.5));
    line.option("--count", count, "a whole number").typeName("N").check(wholeFrom(1, 64));
    line.flag("--loud", loud, "a flag");
    testing::internal::CaptureStdout();
    testing::internal::CaptureStderr();
    const int status = runProgram(line, static_cast<int>(words.size()), words.data(), [this] {
      ++calls;
      if (!failure.empty()) throw Error(failure);
    });
    out = testing::internal::GetCapturedStdout();
    err = testing::internal::GetCapturedStderr();
    return status;
  }

  void expectRejected(const std::vector<const char*>& words, const std::string& sentence) {
    EXPECT_EQ(run(words), 2);
    EXPECT_EQ(err, "a_program: " + sentence + "\n");
    EXPECT_EQ(out, "");
    EXPECT_EQ(calls, 0);
  }

  double size = 1;
  int count = 2;
  bool loud = false;
  int calls = 0;
  std::string failure, out, err;
};

TEST(CommandLine, readsOptionsThenWorks) {
  Program program;
  EXPECT_EQ(program.run({"--size", "2.5", "--loud", "--count", "64"}), 0);
  EXPECT_EQ(program.size, 2.5);
  EXPECT_EQ(program.count, 64);
  EXPECT_TRUE(program.loud);
  EXPECT_EQ(program.calls, 1);
  EXPECT_EQ(program.run({"--size=0.5"}), 0);
  EXPECT_EQ(program.size, 0.5);
  EXPECT_EQ(program.out + program.err, "");
}

TEST(CommandLine, printsHelpInsteadOfWorking) {
  Program program;
  EXPECT_EQ(program.run({"--help"}), 0);
  EXPECT_EQ(program.calls, 0);
  EXPECT_EQ(program.err, "");
  for (const char* text : {"Does nothing.", "Usage: a_program", "--size N", "a number", "print this text and end"})
    EXPECT_NE(program.out.find(text), std::string::npos) << text << " is missing in:\n" << program.out;
}

TEST(CommandLine, rejectsWhatItDoesNotKnow) {
  Program().expectRejected({"--quiet"}, "Option '--quiet' is unknown; see --help.");
  Program().expectRejected({"-q"}, "Option '-q' is unknown; see --help.");
  Program().expectRejected({"--size", "1", "--loude"}, "Option '--loude' is unknown; see --help.");
  Program().expectRejected({"file"}, "'file' is not an option; see --help.");
}

TEST(CommandLine, rejectsValuesThatAreMissingOrOutOfRange) {
  Program().expectRejected({"--size"}, "--size: 1 required N missing; see --help.");
  for (const char* text : {"0.4", "nan", "inf", "-1", "1x", "two"})
    Program().expectRejected({"--size", text},
                             std::string("--size: '") + text + "' is not a number of at least 0.5; see --help.");
  for (const char* text : {"0", "65", "1.5", "-1", "99999999999999999999", "many"})
    Program().expectRejected({"--count", text},
                             std::string("--count: '") + text + "' is not a whole number from 1 to 64; see --help.");
}

TEST(CommandLine, printsTheErrorOfTheWork) {
  Program program;
  program.failure = "The file a.yaml is empty; write a scene into it.";
  EXPECT_EQ(program.run({}), 2);
  EXPECT_EQ(program.err, "a_program: The file a.yaml is empty; write a scene into it.\n");
}

/// What is wrong with a call of a program that has a subcommand and two options of which one must be chosen.
std::string errorOf(std::vector<const char*> words) {
  words.insert(words.begin(), "a_program");
  CommandLine line("Does nothing.");
  OptionList one = line.subcommand("one", "the first");
  line.subcommand("two", "the second");
  line.requireSubcommand();
  std::string file;
  std::vector<int> numbers;
  OptionList input = one.oneRequired("input");
  input.option("--file", file, "to read");
  input.option("--numbers", numbers, "instead").expected(2);
  testing::internal::CaptureStderr();
  const int status = runProgram(line, static_cast<int>(words.size()), words.data(), [&] {
    EXPECT_TRUE(one.isChosen());
    EXPECT_EQ(input.isGiven("--file"), numbers.empty());
    return 7;
  });
  const std::string error = testing::internal::GetCapturedStderr();
  EXPECT_EQ(status, error.empty() ? 7 : 2);
  return error;
}

TEST(CommandLine, KnowsSubcommandsAndWhatExcludesEachOther) {
  EXPECT_EQ(errorOf({"one", "--file", "a"}), "");
  EXPECT_EQ(errorOf({"one", "--numbers", "1", "2"}), "");
  for (const std::vector<const char*>& wrong : std::vector<std::vector<const char*>>{
           {}, {"one"}, {"three"}, {"one", "--file", "a", "--numbers", "1", "2"}, {"one", "--numbers", "1"}})
    EXPECT_NE(errorOf(wrong), "");
  EXPECT_EQ(errorOf({"one", "--fill", "a"}), "a_program: Option '--fill' is unknown; see --help.\n");
}

TEST(OptionCheck, NumbersAreFiniteAndWithinTheirLimits) {
  const OptionCheck check = finiteIn(0, 1);
  for (const char* const good : {"0", "1", "0.5", "1e-3"}) EXPECT_EQ(check.complaint(good), "") << good;
  for (const std::string wrong : {"nan", "inf", "-0.1", "1.1", "", "0.5x"})
    EXPECT_EQ(check.complaint(wrong), "'" + wrong + "' is not a number from 0 to 1");
  for (const char* number : {"0", "2", "0.5", "1e-3"}) EXPECT_EQ(finiteFrom(0).complaint(number), "");
  for (const std::string text : {"-1", "abc", "nan", "inf", "1s"})
    EXPECT_EQ(finiteFrom(0).complaint(text), "'" + text + "' is not a number of at least 0");
}

TEST(OptionCheck, WholeNumbersAreTheDigitsOfAnUnsignedNumber) {
  for (const char* number : {"0", "7", "18446744073709551615"}) EXPECT_EQ(wholeNumber().complaint(number), "");
  for (const std::string text : {"-1", "abc", "1.5", "1e3", "0x10", "3 4"})
    EXPECT_EQ(wholeNumber().complaint(text), "'" + text + "' is not a whole number of at least 0");
  EXPECT_EQ(wholeNumber().complaint("18446744073709551616"),
            "'18446744073709551616' is too large; write at most 18446744073709551615");
}

TEST(OptionCheck, ShowsWhatItAcceptsUnlessHidden) {
  std::string word;
  double number = 0;
  CommandLine line("Does nothing.", "a_program");
  line.option("--word", word, "a word").check(oneOf({"red", "green"}));
  line.option("--number", number, "a number").check(inRange(0.5, 2.0).hidden());
  const char* const words[] = {"a_program", "--help"};
  testing::internal::CaptureStdout();
  EXPECT_EQ(runProgram(line, 2, words, [] { return 1; }), 0);
  const std::string help = testing::internal::GetCapturedStdout();
  EXPECT_NE(help.find("{red,green}"), std::string::npos) << help;
  EXPECT_EQ(help.find("[0.5 - 2]"), std::string::npos) << help;
  EXPECT_NE(oneOf({"red", "green"}).complaint("blue"), "");
  EXPECT_NE(inRange(0.5, 2.0).complaint("3"), "");
}

}  // namespace
}  // namespace vibe::command_line_test
