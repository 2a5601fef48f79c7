#include "vibe_core/trainee/trainee_script.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <string>

#include "vibe_testing/expect_error.hpp"

namespace vibe::trainee_script_test {
namespace {

const std::string kScripts = std::string(VIBE_CORE_DIR) + "/trainees/";

/// A script with the given actions, one per line.
TraineeScript script(const std::string& actions, const std::string& head = "") {
  return TraineeScript::parse("name: t\n" + head + "actions:\n" + actions, "t.yaml");
}

double joint(const TraineeScript& script, int index, double time) {
  return script.at(time).joints[index];
}

TEST(TraineeScript, MovesWithMinimumJerk) {
  const TraineeScript s = script("- {move: {insertion: 8 cm}, in: 4 s}\n", "start: {insertion: 2 cm}\n");
  EXPECT_EQ(s.duration(), 4);
  EXPECT_EQ(joint(s, Insertion, 0), 0.02);
  EXPECT_DOUBLE_EQ(joint(s, Insertion, 2), 0.05);
  EXPECT_EQ(joint(s, Insertion, 4), 0.08);
  const double share = 0.25;  // 10 s^3 - 15 s^4 + 6 s^5 = 0.103515625
  EXPECT_NEAR(joint(s, Insertion, 4 * share), 0.02 + 0.06 * 0.103515625, 1e-15);
  const double speed = (joint(s, Insertion, 2 + 1e-5) - joint(s, Insertion, 2 - 1e-5)) / 2e-5;
  EXPECT_NEAR(speed, 1.875 * 0.06 / 4, 1e-9);
}

TEST(TraineeScript, OutsideItsTimeItRests) {
  const TraineeScript s = script("- {move: {rotation: 1}, in: 1 s}\n- {press: cinch}\n");
  for (const double t : {-1.0, -std::numeric_limits<double>::infinity(), std::nan("")}) {
    EXPECT_EQ(s.at(t).joints, s.at(0).joints);
  }
  for (const double t : {1.0, 99.0, std::numeric_limits<double>::infinity()}) {
    EXPECT_EQ(joint(s, Rotation, t), 1);
    EXPECT_EQ(s.at(t).buttons[Cinch], 1);
  }
}

TEST(TraineeScript, ActionsFollowEachOther) {
  const TraineeScript s = script(
      "- phase: one\n- {move: {insertion: 0.1}, in: 1 s}\n- wait: 2 s\n- phase: two\n"
      "- {move_by: {insertion: -0.03, rotation: 0.5}, in: 1 s}\n");
  EXPECT_EQ(s.duration(), 4);
  EXPECT_EQ(joint(s, Insertion, 1.5), 0.1);
  EXPECT_DOUBLE_EQ(joint(s, Insertion, 4), 0.07);
  EXPECT_DOUBLE_EQ(joint(s, Rotation, 4), 0.5);
  EXPECT_EQ(s.phaseAt(0), "one");
  EXPECT_EQ(s.phaseAt(2.999), "one");
  EXPECT_EQ(s.phaseAt(3), "two");
  EXPECT_EQ(s.phaseAt(100), "two");
}

TEST(TraineeScript, SpeedIsTheMeanSpeed) {
  const TraineeScript s =
      script("- {move: {insertion: 6 cm}, speed: 2 cm/s}\n- {move: {rotation: 90 deg}, speed: 30 deg/s}\n");
  EXPECT_NEAR(s.duration(), 6, 1e-12);
}

TEST(TraineeScript, TogetherOverlaps) {
  const TraineeScript s = script(
      "- wait: 1 s\n- together:\n    - {move: {insertion: 0.1}, in: 4 s}\n    - {move: {rotation: 1}, in: 1 s, after: "
      "2 s}\n"
      "    - {hold: insufflate, for: 3 s}\n- {move: {rotation: 0}, in: 1 s}\n");
  EXPECT_EQ(s.duration(), 6);  // 1 + the longest + 1
  EXPECT_DOUBLE_EQ(joint(s, Insertion, 3), 0.05);
  EXPECT_EQ(joint(s, Rotation, 3), 0);
  EXPECT_DOUBLE_EQ(joint(s, Rotation, 3.5), 0.5);
  EXPECT_EQ(joint(s, Rotation, 5), 1);
  EXPECT_EQ(joint(s, Rotation, 6), 0);
  EXPECT_EQ(s.at(3.9).buttons[Insufflate], 1);
  EXPECT_EQ(s.at(4.0).buttons[Insufflate], 0);
}

/// 0.1 + 0.2 is a little more than 0.3 in binary.
TEST(TraineeScript, MotionsMayFollowWithoutGap) {
  const TraineeScript s = script(
      "- together:\n    - {move: {rotation: 1}, in: 0.2 s, after: 0.1 s}\n"
      "    - {move: {rotation: 2}, in: 0.2 s, after: 0.3 s}\n");
  EXPECT_DOUBLE_EQ(joint(s, Rotation, 0.1 + 0.2), 1);
  EXPECT_EQ(joint(s, Rotation, 0.5), 2);
}

TEST(TraineeScript, ButtonsHaveSharpEdges) {
  const TraineeScript s =
      script("- wait: 1 s\n- press: helix_grab\n- wait: 2 s\n- release: helix_grab\n- {hold: needle, for: 0.5 s}\n");
  EXPECT_EQ(s.at(std::nextafter(1.0, 0.0)).buttons[HelixGrab], 0);
  EXPECT_EQ(s.at(1.0).buttons[HelixGrab], 1);
  EXPECT_EQ(s.at(std::nextafter(3.0, 0.0)).buttons[HelixGrab], 1);
  EXPECT_EQ(s.at(3.0).buttons[HelixGrab], 0);
  EXPECT_EQ(s.at(3.0).buttons[Needle], 1);
  EXPECT_EQ(s.at(3.5).buttons[Needle], 0);
  EXPECT_EQ(s.at(2.0).buttons[ApcPedal], 0);
}

TEST(TraineeScript, IsAPureFunctionOfTime) {
  const TraineeScript one = TraineeScript::load(kScripts + "demo/clumsy_grabs.yaml");
  const TraineeScript two = TraineeScript::load(kScripts + "demo/clumsy_grabs.yaml");
  std::vector<double> times;
  for (double t = 0; t < one.duration(); t += 0.37) times.push_back(t);
  std::vector<StepInput> forward;
  for (const double t : times) forward.push_back(one.at(t));
  std::mt19937 random(3);
  for (int k = 0; k < 2000; ++k) {
    const std::size_t i = random() % times.size();
    EXPECT_EQ(two.at(times[i]).joints, forward[i].joints);
    EXPECT_EQ(two.at(times[i]).buttons, forward[i].buttons);
  }
}

TEST(TraineeScript, TremorRidesOnTheMotion) {
  const std::string move = "- {move: {insertion: 8 cm}, in: 20 s}\n";
  const TraineeScript still = script(move);
  const TraineeScript shaky = script(move, "tremor: {amplitude: {insertion: 1 mm}, scale: 0.5}\n");
  const TraineeScript other = script(move, "seed: 9\ntremor: {amplitude: {insertion: 1 mm}, scale: 0.5}\n");
  double sum = 0;
  for (int k = 0; k < 2000; ++k)
    sum += std::pow(joint(shaky, Insertion, k * 0.01) - joint(still, Insertion, k * 0.01), 2);
  EXPECT_NEAR(std::sqrt(sum / 2000), 0.5e-3, 0.05e-3);
  EXPECT_NE(joint(shaky, Insertion, 7), joint(other, Insertion, 7));
  EXPECT_EQ(joint(shaky, Rotation, 7), 0);
}

TEST(TraineeScript, MotionIsContinuousInTheShippedScripts) {
  for (const char* name : {"demo/five_states", "demo/clumsy_grabs", "demo/grabs", "demo/smoke"}) {
    const TraineeScript s = TraineeScript::load(kScripts + name + ".yaml");
    for (double t = 0; t < s.duration(); t += 1e-3) {
      const StepInput a = s.at(t), b = s.at(t + 1e-3);
      for (int k = 0; k < kJointCount; ++k) {
        EXPECT_TRUE(std::isfinite(a.joints[k]));
        const double fastest = k == Insertion || k == HelixAdvance || k == NeedleDriver ? 0.4 : 40;  // [m/s], [rad/s]
        EXPECT_LT(std::abs(b.joints[k] - a.joints[k]), fastest * 1e-3) << name << " " << kJointNames[k] << " at " << t;
      }
    }
  }
}

TEST(ShippedScripts, TheGrabsFitAMinuteAndAreTwo) {
  const TraineeScript s = TraineeScript::load(kScripts + "demo/grabs.yaml");
  EXPECT_EQ(s.name(), "grabs");
  EXPECT_NEAR(s.duration(), 60, 1e-9);
  int grabs = 0;
  for (double t = 0; t < s.duration(); t += 0.01) {
    grabs += s.at(t).buttons[HelixGrab] == 0 && s.at(t + 0.01).buttons[HelixGrab] == 1;
  }
  EXPECT_EQ(grabs, 2);
  EXPECT_NEAR(joint(s, Insertion, s.duration()), 0, 1e-3);
  for (const std::uint8_t button : s.at(s.duration()).buttons) EXPECT_EQ(button, 0);
}

/// Motion jerk is what tells the two apart: the beginner's hands shake four times as much.
TEST(ShippedScripts, ClumsyHandsShakeMore) {
  const auto shake = [](const TraineeScript& s) {
    double sum = 0;
    for (int k = 0; k < 4000; ++k) {
      const double t = k * 0.01;
      const double bend = joint(s, TipUpDown, t + 0.02) - 2 * joint(s, TipUpDown, t + 0.01) + joint(s, TipUpDown, t);
      sum += bend * bend;
    }
    return std::sqrt(sum);
  };
  EXPECT_GT(shake(TraineeScript::load(kScripts + "demo/clumsy_grabs.yaml")),
            3 * shake(TraineeScript::load(kScripts + "demo/grabs.yaml")));
}

TEST(TraineeScript, LongScriptsAreFine) {
  std::string actions;
  for (int k = 0; k < 20000; ++k) actions += "- {move: {rotation: " + std::to_string(k % 2) + "}, in: 0.5 s}\n";
  const TraineeScript s = script(actions);
  EXPECT_DOUBLE_EQ(s.duration(), 10000);
  EXPECT_DOUBLE_EQ(joint(s, Rotation, 9999.75), 0.5);
}

}  // namespace
}  // namespace vibe::trainee_script_test
