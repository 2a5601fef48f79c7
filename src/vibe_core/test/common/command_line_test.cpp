#include "vibe_core/common/command_line.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "vibe_core/common/error.hpp"

namespace vibe::command_line_test {
namespace {

/// A program with one option of each kind.
struct Program {
  int run(std::vector<const char*> words) {
    words.insert(words.begin(), "a_program");
    CLI::App app{"Does nothing.", "a_program"};
    app.add_option("--size", size, "a number")->type_name("N")->check(finiteFrom(0.5));
    app.add_option("--count", count, "a whole number")->type_name("N")->check(wholeFrom(1, 64));
    app.add_flag("--loud", loud, "a flag");
    testing::internal::CaptureStdout();
    testing::internal::CaptureStderr();
    const int status = runProgram(app, static_cast<int>(words.size()), words.data(), [this] {
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

}  // namespace
}  // namespace vibe::command_line_test
