// However a sender of velocities fails, its motion ends: random senders, in simulated time, with queue and interpreter.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "input/input_interpreter.hpp"
#include "input/input_queue.hpp"
#include "vibe_testing/scope_worlds.hpp"

namespace vibe::sim::velocity_life_test {
namespace {

constexpr std::int64_t kMillisecond = 1'000'000;
constexpr std::int64_t kStart = 1'000'000'000'000;

/// A sender whose messages are late, lost, and stamped by a clock that is wrong or steps.
struct Sender {
  std::int64_t period, hangs, jitter;
  double loss;

  explicit Sender(std::mt19937& random)
      : period(std::uniform_int_distribution<std::int64_t>(2, 150)(random) * kMillisecond),
        hangs(kStart + std::uniform_int_distribution<std::int64_t>(600, 1200)(random) * kMillisecond),
        jitter(period * std::uniform_int_distribution<int>(0, 2)(random)),
        loss(0.2 * std::uniform_int_distribution<int>(0, 2)(random)) {}

  /// 0, right, ahead, behind, or from before: what the door lets pass and what it does not.
  static std::int64_t stampAt(std::int64_t now, std::mt19937& random) {
    const int kind = std::uniform_int_distribution<int>(0, 4)(random);
    const std::int64_t off = std::uniform_int_distribution<std::int64_t>(0, 1200)(random) * kMillisecond;
    return kind == 0 ? 0 : kind == 1 ? now : kind == 2 ? now + off : kind == 3 ? now - off : 5;
  }
};

class VelocityLifeTest : public testing::Test {
 protected:
  test::World world = test::scopeWorld(test::shellUnderScope(0.06), test::openBall(0.06, 1, 2e-3));

  struct Run {
    std::int64_t last_effective = 0;  // latest time from which a message counts [ns]
    std::int64_t last_motion = 0;     // begin of the last step that moved a joint [ns]
    std::int64_t newest = 0;          // stamp of a message [ns]
    std::int64_t step = 0;            // [ns]
    std::vector<std::string> sentences;
  };

  Run run(int seed, std::int64_t life) const {
    std::mt19937 random(static_cast<unsigned>(seed));
    const Sender sender(random);
    Run result;
    result.step = std::uniform_int_distribution<std::int64_t>(5, 20)(random) * kMillisecond;
    InputQueue queue;
    InputInterpreter interpreter(life);
    StepInput input;
    input.joints = {0.05, 0.2, 0.3, -0.2, 0, 0, 0};
    queue.takeDue(kStart);
    std::int64_t next = kStart + 1;
    for (std::int64_t now = kStart + result.step; now < kStart + 3000 * kMillisecond; now += result.step) {
      for (; next <= now; next += sender.period + std::uniform_int_distribution<std::int64_t>(0, sender.jitter)(random))
        if (next < sender.hangs) send(sender, next, queue, random, result);
      const JointArray before = input.joints;
      for (std::string& sentence : interpreter.interpret(queue.takeDue(now), *world.model, input))
        result.sentences.push_back(std::move(sentence));
      if (input.joints != before) result.last_motion = now;
    }
    return result;
  }

  static void send(const Sender& sender, std::int64_t now, InputQueue& queue, std::mt19937& random, Run& result) {
    if (std::uniform_real_distribution<double>(0, 1)(random) < sender.loss) return;
    InputSample sample;
    sample.stamp = Sender::stampAt(now, random);
    sample.target = ScopeTarget::VelocityInWorld;
    sample.tip_twist << 0, 0, 1e-3, 0.01, 0, 0;
    if (!faultOf(sample.stamp, now, InputWindow::ofWallClock()).empty()) return;
    ASSERT_TRUE(queue.push(sample));
    if (sample.stamp != 0 && sample.stamp < result.newest) return;  // overtaken by another
    result.newest = std::max(result.newest, sample.stamp);
    result.last_effective = std::max({result.last_effective, now, sample.stamp});
  }
};

TEST_F(VelocityLifeTest, MotionEndsWithinItsLifeAndAStepHoweverTheSenderFails) {
  int heard = 0;
  for (int seed = 0; seed < 100; ++seed) {
    const Run run = this->run(seed, kVelocityLife);
    if (run.last_effective == 0) continue;  // the door refused all
    ++heard;
    ASSERT_GE(run.last_motion, run.last_effective) << seed;
    ASSERT_LE(run.last_motion, run.last_effective + kVelocityLife + run.step) << seed;
    ASSERT_FALSE(run.sentences.empty()) << seed;
    for (const std::string& sentence : run.sentences)
      ASSERT_EQ(sentence.rfind("scope/servo_cv has been silent", 0), 0u);
  }
  EXPECT_GT(heard, 80);
}

TEST_F(VelocityLifeTest, TheSearchNoticesAVelocityThatLivesLonger) {
  int late = 0;
  for (int seed = 0; seed < 10; ++seed) {
    const Run run = this->run(seed, 2 * kVelocityLife);
    late += run.last_motion > run.last_effective + kVelocityLife + run.step;
  }
  EXPECT_GT(late, 6);
}

TEST_F(VelocityLifeTest, ItFadesAndASenderAtFiveHertzIsNotSlowedDown) {
  InputQueue queue;
  InputInterpreter interpreter;
  StepInput input;
  input.joints = {0.05, 0.2, 0.3, -0.2, 0, 0, 0};
  queue.takeDue(kStart);
  std::int64_t now = kStart;
  const auto moved = [&] {
    const double before = input.joints[Insertion];
    now += 10 * kMillisecond;
    EXPECT_TRUE(interpreter.interpret(queue.takeDue(now), *world.model, input).empty());
    return before - input.joints[Insertion];
  };
  InputSample up;
  up.target = ScopeTarget::VelocityInWorld;
  up.tip_twist << 0, 0, 5e-3, 0, 0, 0;
  double least = 1, most = 0;
  for (int k = 0; k < 100; ++k) {
    up.stamp = now + 1;
    if (k % 20 == 0) {
      ASSERT_TRUE(queue.push(up));
    }
    const double step = moved();
    least = std::min(least, step), most = std::max(most, step);
  }
  EXPECT_GT(least, 0.95 * most);
  double last = moved();  // a fifth of a second after the last message
  for (int k = 0; k < 9; ++k) {
    const double next = moved();
    EXPECT_NEAR(last - next, 0.1 * most, 0.02 * most);
    last = next;
  }
}

}  // namespace
}  // namespace vibe::sim::velocity_life_test
