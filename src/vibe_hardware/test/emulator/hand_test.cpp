// Hands that move the emulated devices.
#include <gtest/gtest.h>

#include <cmath>

#include "vibe_core/program/error.hpp"
#include "vibe_hardware/emulator/hand.hpp"
#include "vibe_hardware/emulator/recorded_hand.hpp"

namespace vibe::hardware::hand_test {
namespace {

constexpr const char* kScript = R"(
name: test
seed: 3
tremor: {amplitude: {insertion: 0.1 mm}}
actions:
  - {move: {insertion: 0.1, rotation: 1, helix_advance: 0.01}, in: 2}
  - {hold: needle, for: 1}
)";

TEST(ScriptedHand, MovesAsTheScriptOfTheTrainee) {
  const TraineeScript script = TraineeScript::parse(kScript, "test");
  const ScriptedHand hand(script);
  EXPECT_EQ(hand.duration(), script.duration());
  for (double t = 0; t < 3.5; t += 0.013) {
    const HandSample sample = hand.at(t);
    const StepInput input = script.at(t);
    for (int joint = 0; joint < kJointCount; ++joint) ASSERT_EQ(sample.joints[joint], input.joints[joint]);
    ASSERT_EQ(sample.buttons, input.buttons);
  }
  EXPECT_EQ(hand.at(2.5).buttons[Needle], 1);
}

constexpr const char* kRecording = R"(# recorded in a test
rotation, insertion,tip_up_down,tip_left_right,time,needle

0,0,0,0,0.5,0
1,0.1,-0.2,0.4,1.5,1
1,0.1,-0.2,0.4,2.0,0
)";

TEST(RecordedHand, InterpolatesPositionsAndHoldsButtons) {
  const RecordedHand hand = RecordedHand::parse(kRecording, "hand.csv");
  EXPECT_EQ(hand.duration(), 2);
  EXPECT_EQ(hand.at(0).joints[Insertion], 0);
  EXPECT_NEAR(hand.at(1).joints[Insertion], 0.05, 1e-15);
  EXPECT_NEAR(hand.at(1.25).joints[Rotation], 0.75, 1e-15);
  EXPECT_NEAR(hand.at(1).joints[TipLeftRight], 0.2, 1e-15);
  EXPECT_EQ(hand.at(1.49).buttons[Needle], 0);
  EXPECT_EQ(hand.at(1.5).buttons[Needle], 1);
  EXPECT_EQ(hand.at(9).buttons[Needle], 0);
  EXPECT_EQ(hand.at(9).joints[TipUpDown], -0.2);
}

TEST(RecordedHand, TakesALeadingPlus) {
  const std::string head = "time,insertion,rotation,tip_up_down,tip_left_right\n";
  const RecordedHand hand = RecordedHand::parse(head + "+0,+0.5,-1,+1e-1,0\n", "hand.csv");
  EXPECT_EQ(hand.at(0).joints[Insertion], 0.5);
  EXPECT_EQ(hand.at(0).joints[TipUpDown], 0.1);
}

std::string errorOf(const std::string& text, const HandLimits& limits = {}) {
  try {
    RecordedHand::parse(text, "hand.csv", limits);
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

TEST(RecordedHand, NamesTheLineAndTheRemedyOfEveryMistake) {
  const std::string head = "time,insertion,rotation,tip_up_down,tip_left_right\n";
  const std::pair<std::string, std::string> mistakes[] = {
      {"", "hand.csv: is empty; the first line has the names of the columns, then rows follow."},
      {"\n# nothing\n", "hand.csv: is empty; the first line has the names of the columns, then rows follow."},
      {head, "hand.csv:1: has no row below the names of the columns; add at least one."},
      {"time,insertion,rotation,tip_up_down\n", "hand.csv:1: column 'tip_left_right' is missing; add it."},
      {"time,time,insertion\n", "hand.csv:1: column 'time' is there twice; remove one."},
      {"time,insertoin\n", "hand.csv:1: column 'insertoin' is not known; did you mean 'insertion'?"},
      {head + "0,0,0,0\n", "hand.csv:2: has 4 values; write 5, one for each column."},
      {head + "0,0,0,0,x\n", "hand.csv:2: tip_left_right: 'x' is not a finite number; write one, with a point."},
      {head + "0,nan,0,0,0\n", "hand.csv:2: insertion: 'nan' is not a finite number; write one, with a point."},
      {head + "0,0,0,0,\n", "hand.csv:2: tip_left_right: '' is not a finite number; write one, with a point."},
      {head + "-1,0,0,0,0\n", "hand.csv:2: time is negative; begin at 0 or later."},
      {head + "0,0,0,0,0\n0,0,0,0,0\n",
       "hand.csv:3: time 0.000000 does not follow the time of the row before; sort the rows by time."},
      {"time,insertion,rotation,tip_up_down,tip_left_right,needle\n0,0,0,0,0,2\n",
       "hand.csv:2: needle: '2' is not 0 or 1; write 1 while it is pressed."},
  };
  for (const auto& [text, message] : mistakes) EXPECT_EQ(errorOf(text), message);
  for (const std::string cell : {"+", "++1", "+-1", "-+1", "+nan", "+ 1"})
    EXPECT_EQ(errorOf(head + "0,0,0,0," + cell + "\n"),
              "hand.csv:2: tip_left_right: '" + cell + "' is not a finite number; write one, with a point.");
}

TEST(RecordedHand, RefusesPositionsFarBeyondTheLimitsOfTheCalibration) {
  const HandLimits limits = handLimits(Calibration::load("../config/devices.yaml"));
  const std::string head = "time,insertion,rotation,tip_up_down,tip_left_right,needle_driver\n";
  EXPECT_EQ(errorOf(head + "0,0.08,1,2,-1,0.01\n1,0.31,3.2,3,-2,0.02\n", limits), "");  // pushes a little too far
  EXPECT_EQ(
      errorOf(head + "0,0,0,0,0,0\n1,80,0,0,0,0\n", limits),
      "hand.csv:3: insertion: 80 m is far beyond the limits of the calibration, 0 m to 0.3 m; write positions in m "
      "and rad.");
  EXPECT_EQ(errorOf(head + "0,0,0,-30,0,0\n", limits),
            "hand.csv:2: tip_up_down: -30 rad is far beyond the limits of the calibration, -1.571 rad to 2.862 rad; "
            "write positions in m and rad.");
  EXPECT_EQ(errorOf(head + "0,0,0,0,0,12\n", limits),
            "hand.csv:2: needle_driver: 12 m is far beyond the limits of the calibration, 0 m to 0.018 m; write "
            "positions in m and rad.");
}

TEST(RecordedHand, SaysWhenItsFileIsMissingOrAFolder) {
  const auto problem = [](const std::string& file) -> std::string {
    try {
      RecordedHand::load(file, {});
    } catch (const Error& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_EQ(problem("no such file.csv"),
            "Cannot read the recorded hand 'no such file.csv'; check path and permissions.");
  EXPECT_EQ(problem("emulator"), "'emulator' is a folder; name the CSV file of a hand in it.");
}

TEST(RandomHand, StaysWithinItsLimitsAndItsSpeeds) {
  double swept = 0;
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const RandomHand hand(seed);
    HandSample last = hand.at(2);
    for (double t = 2; t < 120; t += 0.01) {
      const HandSample sample = hand.at(t);
      for (int joint = 0; joint < kScopeJointCount; ++joint) {
        const RandomRange& range = kRandomRanges[joint];
        ASSERT_GE(sample.joints[joint], range.low);
        ASSERT_LE(sample.joints[joint], range.high);
        ASSERT_LE(std::abs(sample.joints[joint] - last.joints[joint]), 0.01 * range.speed * (1 + 1e-9));
      }
      swept += std::abs(sample.joints[Insertion] - last.joints[Insertion]);
      last = sample;
    }
  }
  EXPECT_GT(swept, 20 * 1.0);  // of insertion, 1 m in two minutes: it does move
}

TEST(RandomHand, BeginsAtZeroIsRepeatableAndDependsOnTheSeed) {
  const RandomHand a(7), b(7), c(8);
  for (const double joint : a.at(0).joints) EXPECT_EQ(joint, 0);
  int pressed = 0, differing = 0;
  for (double t = 0; t < 300; t += 0.1) {
    ASSERT_EQ(a.at(t).joints, b.at(t).joints);
    ASSERT_EQ(a.at(t).buttons, b.at(t).buttons);
    differing += a.at(t).joints != c.at(t).joints && a.at(t).buttons != c.at(t).buttons ? 1 : 0;
    for (const auto button : a.at(t).buttons) pressed += button;
  }
  EXPECT_GT(pressed, 100);
  EXPECT_GT(differing, 100);
}

}  // namespace
}  // namespace vibe::hardware::hand_test
