// Several nodes at the joints: random sequences of senders that move, rest, hang and move to goals.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <random>
#include <set>

#include "input/input_interpreter.hpp"
#include "input/input_queue.hpp"
#include "vibe_testing/scope_fixture.hpp"

namespace vibe::sim::hand_over_test {
namespace {

constexpr std::int64_t kMillisecond = 1'000'000, kStep = 10 * kMillisecond;
const SampleSender kPad{"scope/servo_jp", "/pad"}, kHand{"scope/input/joint_states", "/hand"},
    kScript{"scope/move_jp", "/script"};

/// Messages that come, and the joints that follow them as fast as they may.
struct Bench {
  Model model;
  InputQueue queue;
  InputInterpreter interpreter;
  StepInput input;
  JointArray hand{0.1, 0, 0, 0, 0, 0, 0};  ///< of the simulator
  std::int64_t now = 1'000'000'000;
  std::vector<std::string> sentences;

  Bench() {
    static const auto kTool = std::make_shared<ToolModel>(loadScope());
    model.tool = kTool;
    input.joints = hand;
    queue.takeDue(now);
  }
  void send(const SampleSender* sender, double insertion, bool move = false) {
    InputSample sample;
    sample.sender = sender;
    sample.stamp = now + 1;
    sample.joints[Insertion] = insertion;
    sample.move = move;
    ASSERT_TRUE(queue.push(sample));
  }
  /// @return how far the command has moved [m]
  double step() {
    now += kStep;
    const double before = input.joints[Insertion];
    for (std::string& sentence : interpreter.interpret(queue.takeDue(now), model, input, hand))
      sentences.push_back(std::move(sentence));
    const double most = model.tool->limits()[Insertion].velocity * 1e-9 * kStep;
    hand[Insertion] += std::clamp(input.joints[Insertion] - hand[Insertion], -most, most);
    return input.joints[Insertion] - before;
  }
};

TEST(HandOver, ANodeThatRepeatsItselfPullsNothingBack) {
  Bench bench;
  for (int k = 0; k < 50; ++k) bench.send(&kPad, 0.1), bench.step();
  bench.send(&kScript, 0.13, true);
  for (int k = 0; k < 100; ++k) bench.send(&kPad, 0.1 + 0.0005 * (k % 2)), bench.step();
  EXPECT_NEAR(bench.hand[Insertion], 0.13, 1e-9);
  EXPECT_TRUE(bench.sentences.empty());
  for (int k = 0; k < 50; ++k) bench.send(&kPad, 0.1 + 0.0003 * k), bench.step();
  EXPECT_NEAR(bench.hand[Insertion], 0.1147, 1e-9) << "it moves, so it drives";
}

TEST(HandOver, AMoveIsEndedByAHandThatMoves) {
  Bench bench;
  for (int k = 0; k < 50; ++k) bench.send(&kHand, 0.1), bench.step();
  bench.send(&kScript, 0.2, true);
  for (int k = 0; k < 20; ++k) bench.send(&kHand, 0.1), bench.step();
  EXPECT_TRUE(bench.interpreter.moves(InputChannel::Scope));
  for (int k = 0; k < 20; ++k) bench.send(&kHand, 0.1 - 0.0003 * k), bench.step();
  EXPECT_FALSE(bench.interpreter.moves(InputChannel::Scope));
  EXPECT_NEAR(bench.input.joints[Insertion], 0.0943, 1e-9);
}

TEST(HandOver, OfTwoThatMoveAtOnceTheLaterDrivesAndTheOtherIsNamed) {
  Bench bench;
  for (int k = 0; k < 50; ++k) bench.send(&kPad, 0.1), bench.send(&kHand, 0.1), bench.step();
  for (int k = 0; k < 100; ++k) {
    bench.send(&kPad, 0.1 + 0.0005 * k);
    bench.send(&kHand, k < 20 ? 0.1 : 0.1 - 0.0005 * (k - 20));
    bench.step();
  }
  EXPECT_NEAR(bench.input.joints[Insertion], 0.1 - 0.0005 * 79, 1e-9);
  ASSERT_FALSE(bench.sentences.empty());
  const std::set<std::string> once(bench.sentences.begin(), bench.sentences.end());
  ASSERT_EQ(once.size(), 1u);
  EXPECT_EQ(once.begin()->rfind("scope/servo_jp of /pad is ignored while scope/input/joint_states of /hand", 0), 0u);
}

/// A node that streams positions, and now and then moves, rests or falls silent.
struct Streamer {
  const SampleSender* sender;
  double place, speed = 0;
  bool silent = false;
  int rests = 0;  ///< steps since it has moved or was silent

  void change(std::mt19937& random) {
    const int kind = std::uniform_int_distribution<int>(0, 3)(random);
    silent = kind == 0;
    speed = kind == 1 ? std::uniform_real_distribution<double>(-0.03, 0.03)(random) : 0;
  }
  void go() {
    place += speed * 1e-9 * kStep;
    rests = silent || speed != 0 ? 0 : rests + 1;
  }
};

/// The farthest that a node at rest has pulled the command to its own place in a step [m].
double farthestPull(int seed, bool named) {
  std::mt19937 random(static_cast<unsigned>(seed));
  std::uniform_real_distribution<double> share(0, 1);
  Bench bench;
  std::array<Streamer, 2> streamers{{{&kPad, 0.1}, {&kHand, 0.11}}};
  double farthest = 0;
  for (int k = 0; k < 300; ++k) {
    for (Streamer& each : streamers) {
      if (share(random) < 0.02) each.change(random);
      each.go();
      if (!each.silent) bench.send(named ? each.sender : nullptr, each.place);
    }
    if (share(random) < 0.01) bench.send(named ? &kScript : nullptr, 0.05 + 0.2 * share(random), true);
    const double by = std::abs(bench.step());
    for (const Streamer& each : streamers)
      if (1e-9 * static_cast<double>(each.rests * kStep) > 0.4 && bench.input.joints[Insertion] == each.place)
        farthest = std::max(farthest, by);
  }
  return farthest;
}

TEST(HandOver, InRandomSequencesNoNodeAtRestPulls) {
  for (int seed = 0; seed < 1000; ++seed) ASSERT_LE(farthestPull(seed, true), 1e-3) << seed;
}

TEST(HandOver, TheSearchNoticesNodesThatAreNotToldApart) {
  double farthest = 0;
  for (int seed = 0; seed < 20; ++seed) farthest = std::max(farthest, farthestPull(seed, false));
  EXPECT_GT(farthest, 0.01);
}

}  // namespace
}  // namespace vibe::sim::hand_over_test
