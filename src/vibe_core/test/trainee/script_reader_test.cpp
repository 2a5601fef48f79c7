#include "vibe_core/trainee/trainee_script.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "scene/mutation.hpp"
#include "vibe_testing/expect_error.hpp"

namespace vibe::script_reader_test {
namespace {

/// The actions begin on line 3.
void play(const std::string& actions) {
  TraineeScript::parse("name: t\nactions:\n" + actions, "t.yaml");
}
void read(const std::string& yaml) {
  TraineeScript::parse(yaml, "t.yaml");
}

TEST(ScriptReader, TheFrameOfAScript) {
  EXPECT_EQ(errorOf([] { read("name: t\nactions: [{wait: 1}]"); }), "no error");
  EXPECT_ERROR(read("name: t\n"), "t.yaml:1: has no actions");
  EXPECT_ERROR(read("name: t\nactions: []\n"), "has no actions");
  EXPECT_ERROR(read("actions: [{wait: 1}]\n"), "has no name");
  EXPECT_ERROR(read("name: t\naction: []\n"), "t.yaml:2: action: is not a known key; did you mean 'actions'?");
  EXPECT_ERROR(read("name: t\nactions: {}\n"), "t.yaml:2: actions: is a map, but a list is needed");
  EXPECT_ERROR(read("name: t\nseed: -1\n"), "out of range");
  EXPECT_ERROR(TraineeScript::load("/nowhere.yaml"), "/nowhere.yaml: cannot be opened");
}

TEST(ScriptReader, StartAndTremor) {
  EXPECT_ERROR(read("name: t\nstart: {insertoin: 3}\n"), "'insertoin' is not a joint; did you mean 'insertion'?");
  EXPECT_ERROR(read("name: t\nstart: {insertion: 3 deg}\n"),
               "t.yaml:2: start.insertion: '3 deg' is an angle, but it must be a length");
  EXPECT_ERROR(read("name: t\ntremor: {frequency: [12, 8]}\n"), "has its upper end first");
  EXPECT_ERROR(read("name: t\ntremor: {frequency: 8}\n"), "must be a list of 2");
  EXPECT_ERROR(read("name: t\ntremor: {frequency: [8, 400]}\n"), "tremor.frequency[1]: '400' is out of range");
  EXPECT_ERROR(read("name: t\ntremor: {amplitude: {rotation: 90 deg}}\n"), "out of range");
  EXPECT_ERROR(read("name: t\ntremor: {scale: 11}\n"), "out of range");
  EXPECT_ERROR(read("name: t\ntremor: {size: 1}\n"), "known are frequency, amplitude, scale");
}

TEST(ScriptReader, VerbsAndTheirOptions) {
  EXPECT_ERROR(play("- {mvoe: {insertion: 1 cm}, in: 1 s}\n"),
               "t.yaml:3: actions[0].mvoe: is not an action; did you mean 'move'?");
  EXPECT_ERROR(play("- {}\n"), "t.yaml:3: actions[0]: is empty");
  EXPECT_ERROR(play("- 5\n"), "actions[0]: is a single value, but a map is needed");
  EXPECT_ERROR(play("- {wait: 1 s, press: cinch}\n"), "is a second action in one item");
  EXPECT_ERROR(play("- {wait: 1 s, in: 2 s}\n"), "actions[0].in: does not go with 'wait'; remove it");
  EXPECT_ERROR(play("- {hold: cinch, four: 2 s}\n"), "does not go with 'hold'; did you mean 'for'?");
  EXPECT_ERROR(play("- wait: 1 s\n- wait: -1 s\n"), "t.yaml:4: actions[1].wait: '-1 s' is out of range");
  EXPECT_ERROR(play("- wait: 1 m\n"), "is a length, but it must be a time");
  EXPECT_ERROR(play("- phase: [a]\n"), "actions[0].phase: is a list");
}

TEST(ScriptReader, Moves) {
  EXPECT_ERROR(play("- {move: {insertion: 1 cm}}\n"), "does not say how long it takes");
  EXPECT_ERROR(play("- {move: {}, in: 1 s}\n"), "names no joint");
  EXPECT_ERROR(play("- {move: insertion, in: 1 s}\n"), "but a map is needed");
  EXPECT_ERROR(play("- {move: {insertion: 1 cm}, in: 1 s, speed: 1 cm/s}\n"), "contradicts 'in'");
  EXPECT_ERROR(play("- {move: {insertion: 1 cm, rotation: 1}, speed: 1 cm/s}\n"), "needs a single joint");
  EXPECT_ERROR(play("- {move: {insertion: 1 cm}, speed: 1 deg/s}\n"), "must be a speed");
  EXPECT_ERROR(play("- {move: {insertion: 1 cm}, speed: 0}\n"), "out of range");
  EXPECT_ERROR(play("- {move: {insertion: 1 cm}, in: 0 s}\n"), "out of range");
  EXPECT_ERROR(play("- {move: {insertion: 20 m}, in: 1 s}\n"), "out of range");
  EXPECT_ERROR(play("- {move: {insertion: .nan}, in: 1 s}\n"), "not finite");
  EXPECT_ERROR(play("- {move: {rotation: 1 rad, rotation: 2 rad}, in: 1 s}\n"), "is given a second time");
  EXPECT_ERROR(play("- {move_by: {insertion: 0.6}, in: 1 s}\n- {move_by: {insertion: 0.6}, in: 1 s}\n"),
               "leads to 1.2 m");
}

TEST(ScriptReader, Groups) {
  EXPECT_ERROR(
      play(
          "- together:\n    - {move: {insertion: 1 cm}, in: 3 s}\n    - {move: {insertion: 0}, in: 1 s, after: 2 s}\n"),
      "t.yaml:5: actions[0].together[1].move.insertion: begins to move at 2.000 s, but an action before still moves it "
      "until 3.000 s");
  EXPECT_EQ(errorOf([] {
              play(
                  "- together:\n    - {move: {insertion: 1 cm}, in: 2 s}\n"
                  "    - {move: {insertion: 0}, in: 1 s, after: 2 s}\n");
            }),
            "no error");
  EXPECT_ERROR(play("- together: []\n"), "is an empty list");
  EXPECT_ERROR(play("- together: [{wait: 1 s}]\n"), "cannot stand inside 'together'");
  EXPECT_ERROR(play("- together: [{together: [{press: cinch}]}]\n"), "cannot stand inside 'together'");
}

TEST(ScriptReader, Buttons) {
  EXPECT_ERROR(play("- press: cinsh\n"), "'cinsh' is not a button; did you mean 'cinch'?");
  EXPECT_ERROR(play("- press: cinch\n- wait: 1 s\n- press: cinch\n"),
               "t.yaml:5: actions[2].press: 'cinch' is already pressed at 1.000 s");
  EXPECT_ERROR(play("- release: cinch\n"), "'cinch' is already released");
  EXPECT_ERROR(play("- press: cinch\n- release: cinch\n"), "too soon after");
  EXPECT_ERROR(play("- {hold: cinch, for: 0.01 s}\n"), "out of range");
  EXPECT_ERROR(play("- hold: cinch\n"), "does not say how long");
  EXPECT_EQ(errorOf([] { play("- press: cinch\n- wait: 0.1 s\n- release: cinch\n"); }), "no error");
}

TEST(ScriptReader, Limits) {
  EXPECT_ERROR(play("- wait: 23 h\n- wait: 2 h\n"), "t.yaml:4: actions[1]: ends after more than 24 h");
  EXPECT_ERROR(play("- {hold: cinch, for: 24 h, after: 1 s}\n"), "more than 24 h");
  std::string many;
  for (int k = 0; k < 100001; ++k) many += "- wait: 0\n";
  EXPECT_ERROR(play(many), "t.yaml:100003: actions[100000]: is one action too many");
}

/// Aliases repeat actions without making the file longer; the number of actions is what is limited.
TEST(ScriptReader, AliasesCannotMultiplyWithoutEnd) {
  std::string group = "- together: &g [";
  for (int k = 0; k < 1000; ++k)
    group += "{move: {rotation: 0}, in: 10 ms, after: " + std::to_string(10 * k) + " ms}, ";
  group += "]\n";
  for (int k = 0; k < 200; ++k) group += "- together: *g\n";
  EXPECT_ERROR(play(group), "too many");
  EXPECT_ERROR(play("- together: &g [*g]\n"), "t.yaml:3: ");
}

TEST(ScriptReader, DamagedScriptsGiveAScriptOrAnErrorWithItsPlace) {
  Mutator mutator(2000);
  int good = 0, refused = 0;
  for (const char* name : {"demo/five_states", "demo/clumsy_grabs", "demo/smoke"}) {
    std::stringstream text;
    text << std::ifstream(std::string(VIBE_CORE_DIR) + "/trainees/" + name + ".yaml").rdbuf();
    for (int k = 0; k < 1000; ++k) {
      const std::string damaged = mutator.mutate(text.str());
      const std::string message = errorOf([&] { read(damaged); });
      (message == "no error" ? good : refused) += 1;
      const bool has_place = message.rfind("t.yaml:", 0) == 0 && std::isdigit(static_cast<unsigned char>(message[7]));
      ASSERT_TRUE(message == "no error" || has_place) << message << "\n" << damaged;
      ASSERT_EQ(message.find('\n'), std::string::npos) << message;
    }
  }
  EXPECT_GT(good, 100);
  EXPECT_GT(refused, 1000);
}

}  // namespace
}  // namespace vibe::script_reader_test
