// Messages that are late, early, out of order or of one stamp, in random sequences: a press is never lost, and of
// joints the latest stamp of a node wins.
#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <vector>

#include "input/input_interpreter.hpp"
#include "input/input_queue.hpp"

namespace vibe::sim::input_order_test {
namespace {

constexpr std::int64_t kMillisecond = 1'000'000, kStep = 16 * kMillisecond, kStart = 1'000'000'000'000;
const SampleSender kPad{"scope/servo_jp", "/pad"}, kScript{"scope/servo_jp", "/script"};

struct Bench {
  Model model;  // without a tool
  InputQueue queue;
  InputInterpreter interpreter;
  StepInput input;
  std::int64_t now = kStart;
  std::vector<std::string> sentences;

  Bench() { queue.takeDue(now); }
  void send(InputChannel channel, std::int64_t stamp, double value, const SampleSender* sender = nullptr) {
    InputSample sample;
    sample.channel = channel;
    sample.sender = sender;
    sample.stamp = stamp;
    sample.joints[Insertion] = value;
    sample.buttons[TTag] = value > 0;
    ASSERT_TRUE(queue.push(sample));
  }
  void step() {
    now += kStep;
    sentences = interpreter.interpret(queue.takeDue(now), model, input);
  }
};

/// 0, now, late by up to six steps, in advance by as much, or that of the message before.
std::int64_t anyStamp(std::int64_t now, std::int64_t before, std::mt19937& random) {
  const std::int64_t off = std::uniform_int_distribution<std::int64_t>(0, 100)(random) * kMillisecond;
  const std::int64_t stamps[] = {0, now, now - off, now + off, before};
  return stamps[std::uniform_int_distribution<int>(0, 4)(random)];
}

/// A message to the buttons, and when it counts: at its stamp, or from when it comes if that is later.
struct Press {
  std::int64_t counts;
  bool down;
};

struct Presses {
  int lost = 0, within_a_step = 0;
};

/// How many presses, each a message "pressed" after one "let go", reach neither the step at which they count nor the
/// next one.
Presses countPresses(std::vector<Press> sent, const std::vector<std::uint8_t>& pressed) {
  std::stable_sort(sent.begin(), sent.end(), [](const Press& a, const Press& b) { return a.counts < b.counts; });
  const auto step = [](const Press& press) { return static_cast<std::size_t>((press.counts - kStart - 1) / kStep); };
  Presses presses;
  for (std::size_t k = 0; k < sent.size(); ++k) {
    if (!sent[k].down || (k > 0 && sent[k - 1].down)) continue;
    presses.lost += !pressed.at(step(sent[k])) && !pressed.at(step(sent[k]) + 1);
    presses.within_a_step += k + 1 < sent.size() && !sent[k + 1].down && step(sent[k]) == step(sent[k + 1]);
  }
  return presses;
}

Presses randomPresses(int seed) {
  std::mt19937 random(static_cast<unsigned>(seed));
  Bench bench;
  std::vector<Press> sent;
  std::vector<std::uint8_t> pressed;
  std::int64_t stamp = bench.now;
  for (int k = 0; k < 200; ++k) {
    for (auto count = k < 190 ? random() % 4 : 0; count > 0; --count) {
      stamp = anyStamp(bench.now + kStep / 2, stamp, random);
      sent.push_back({std::max(bench.now + 1, stamp), random() % 2 == 0});
      bench.send(InputChannel::Buttons, stamp, sent.back().down);
    }
    bench.step();
    pressed.push_back(bench.input.buttons[TTag]);
  }
  return countPresses(sent, pressed);
}

TEST(InputOrder, NoPressIsLostWhateverTheStamps) {
  int within_a_step = 0;
  for (int seed = 0; seed < 200; ++seed) {
    const Presses presses = randomPresses(seed);
    ASSERT_EQ(presses.lost, 0) << seed;
    within_a_step += presses.within_a_step;
  }
  EXPECT_GT(within_a_step, 1000) << "the search has presses that come and go within a step";
}

TEST(InputOrder, OfEqualMessagesOfButtonsOneWaits) {
  Bench bench;
  for (int k = 0; k < 10000; ++k) bench.send(InputChannel::Buttons, bench.now + 1, 1);
  bench.step();
  EXPECT_EQ(bench.input.buttons[TTag], 1);
}

struct Sent {
  std::int64_t stamp;
  double value;
};

/// What the page says: of what is due and of one node, the latest stamp; of equal ones the last that came.
double latestOf(const std::vector<Sent>& sent, std::int64_t now, double otherwise) {
  Sent best{0, otherwise};
  for (const Sent& each : sent)
    if (each.stamp <= now && each.stamp >= best.stamp) best = each;
  return best.value;
}

TEST(InputOrder, OfJointsTheLatestStampWins) {
  int overtaken = 0;
  for (int seed = 0; seed < 200; ++seed) {
    std::mt19937 random(static_cast<unsigned>(seed));
    Bench bench;
    std::vector<Sent> sent;
    std::int64_t stamp = bench.now;
    for (int k = 0; k < 200; ++k) {
      for (auto count = random() % 4; count > 0; --count) {
        stamp = anyStamp(bench.now + kStep / 2, stamp, random);
        if (stamp == 0) stamp = bench.now;
        sent.push_back({stamp, 1e-3 * static_cast<double>(sent.size() + 1)});
        bench.send(InputChannel::Scope, stamp, sent.back().value, &kPad);
      }
      bench.step();
      ASSERT_EQ(bench.input.joints[Insertion], latestOf(sent, bench.now, 0)) << seed << ", step " << k;
      overtaken += !bench.sentences.empty();
    }
  }
  EXPECT_GT(overtaken, 1000) << "the search has messages that come too late";
}

TEST(InputOrder, AnOvertakenMessageIsNamedAndOfAnotherNodeItIsNone) {
  Bench bench;
  bench.send(InputChannel::Scope, bench.now + kMillisecond, 0.03, &kPad);
  bench.step();
  bench.send(InputChannel::Scope, bench.now - 115 * kMillisecond, 0.01, &kPad);
  bench.step();
  EXPECT_EQ(bench.input.joints[Insertion], 0.03);
  ASSERT_EQ(bench.sentences.size(), 1u);
  EXPECT_EQ(bench.sentences[0],
            "A message on scope/servo_jp from /pad is ignored: its stamp is 0.1 s before that of one of the same node "
            "that is used already; send messages in the order of their stamps.");
  bench.send(InputChannel::Scope, bench.now - 100 * kMillisecond, 0.02, &kScript);
  bench.step();
  EXPECT_EQ(bench.input.joints[Insertion], 0.02);
  EXPECT_TRUE(bench.sentences.empty());
}

TEST(InputOrder, ANodeWhoseClockStepsBackCountsAgainAfterASecond) {
  Bench bench;
  const std::int64_t behind = 10'000 * kMillisecond;
  bench.send(InputChannel::Scope, bench.now + 1, 0.5, &kPad);
  bench.step();
  const std::int64_t used = bench.now;
  while (bench.input.joints[Insertion] == 0.5 && bench.now < used + 2 * kOvertakes) {
    bench.send(InputChannel::Scope, bench.now - behind, 0.1, &kPad);
    bench.step();
  }
  EXPECT_EQ(bench.input.joints[Insertion], 0.1);
  EXPECT_GE(bench.now, used + kOvertakes);
  EXPECT_LE(bench.now, used + kOvertakes + 2 * kStep);
  bench.send(InputChannel::Scope, bench.now - behind, 0.2, &kPad);
  bench.step();
  EXPECT_EQ(bench.input.joints[Insertion], 0.2) << "and stays heard";
}

TEST(InputOrder, TimeThatIsSetBackOvertakesNobody) {
  for (const bool cleared : {false, true}) {
    Bench bench;
    bench.send(InputChannel::Scope, bench.now + 1, 0.5, &kPad);
    bench.step();
    bench.now = kStart / 2;
    if (cleared) bench.queue.clear();
    bench.step();
    bench.send(InputChannel::Scope, bench.now, 0.1, &kPad);
    bench.step();
    EXPECT_EQ(bench.input.joints[Insertion], 0.1);
  }
}

}  // namespace
}  // namespace vibe::sim::input_order_test
