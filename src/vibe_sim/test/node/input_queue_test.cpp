// What is applied when, and what it means to a model: InputQueue and InputInterpreter together.
#include "input/input_queue.hpp"

#include <gtest/gtest.h>

#include "input/input_interpreter.hpp"
#include "vibe_testing/worlds.hpp"

namespace vibe::sim::input_queue_test {
namespace {

InputSample scopeAt(double insertion, std::int64_t stamp) {
  InputSample sample;
  sample.stamp = stamp;
  sample.joints[Insertion] = insertion;
  return sample;
}

InputSample buttonsAt(std::uint8_t grab, std::int64_t stamp) {
  InputSample sample;
  sample.channel = InputChannel::Buttons;
  sample.stamp = stamp;
  sample.buttons[HelixGrab] = grab;
  return sample;
}

InputSample suturingDeviceAt(double advance, std::int64_t stamp) {
  InputSample sample;
  sample.channel = InputChannel::SuturingDevice;
  sample.stamp = stamp;
  sample.joints[HelixAdvance] = advance;
  return sample;
}

InputSample pullAt(int particle, double x, std::int64_t stamp) {
  InputSample sample;
  sample.channel = InputChannel::Pull;
  sample.stamp = stamp;
  sample.pull_particle = particle;
  sample.pull_target.x() = x;
  return sample;
}

class InputQueueTest : public testing::Test {
 protected:
  InputQueue queue;
  InputInterpreter interpreter;
  Model model;  // without a tool
  StepInput input;
  std::vector<std::string> apply(std::int64_t stamp, bool real_time = true) {
    const DueInput& due = queue.takeDue(stamp);
    std::vector<std::string> sentences = interpreter.interpret(due, model, input);
    const std::string released = real_time ? releaseSilentButtons(due, input) : "";
    if (!released.empty()) sentences.push_back(released);
    return sentences;
  }
};

TEST_F(InputQueueTest, futureSamplesWaitUntilTheyAreDue) {
  queue.push(scopeAt(0.1, 100));
  queue.push(scopeAt(0.2, 200));
  apply(99);
  EXPECT_EQ(input.joints[Insertion], 0.0);
  apply(100);
  EXPECT_EQ(input.joints[Insertion], 0.1);
  apply(1000);
  EXPECT_EQ(input.joints[Insertion], 0.2);
}

TEST_F(InputQueueTest, lastValueStaysInForce) {
  queue.push(buttonsAt(1, 10));
  apply(10);
  apply(20);
  EXPECT_EQ(input.buttons[HelixGrab], 1);
}

TEST_F(InputQueueTest, stampZeroAndThePastCountAsNow) {
  apply(500);
  queue.push(scopeAt(0.1, 300));
  queue.push(scopeAt(0.2, 400));
  apply(501);
  EXPECT_EQ(input.joints[Insertion], 0.2);
  queue.push(scopeAt(0.3, 400));
  queue.push(scopeAt(0.4, 0));
  apply(502);
  EXPECT_EQ(input.joints[Insertion], 0.4) << "without a stamp it is as new as can be";
}

TEST_F(InputQueueTest, samplesOutOfOrderAreAppliedInTheOrderOfStamps) {
  queue.push(scopeAt(0.3, 300));
  queue.push(scopeAt(0.1, 100));
  queue.push(scopeAt(0.2, 200));
  apply(250);
  EXPECT_EQ(input.joints[Insertion], 0.2);
}

TEST_F(InputQueueTest, aRepeatedStampReplacesWhatWaits) {
  for (int i = 0; i < 10000; ++i) EXPECT_TRUE(queue.push(scopeAt(0.001 * i, 100)));
  apply(100);
  EXPECT_DOUBLE_EQ(input.joints[Insertion], 9.999);
}

TEST_F(InputQueueTest, channelsTouchTheirOwnValuesOnly) {
  input.joints = {1, 2, 3, 4, 5, 6, 7};
  queue.push(suturingDeviceAt(0.01, 1));
  apply(1);
  EXPECT_EQ(input.joints, (std::array<double, kJointCount>{1, 2, 3, 4, 0.01, 0, 0}));
  queue.push(scopeAt(0.02, 2));
  apply(2);
  EXPECT_EQ(input.joints, (std::array<double, kJointCount>{0.02, 0, 0, 0, 0.01, 0, 0}));
}

TEST_F(InputQueueTest, aFullChannelRefusesAndTheOthersDoNotCare) {
  for (std::size_t i = 0; i < InputQueue::kCapacity; ++i) {
    ASSERT_TRUE(queue.push(scopeAt(0, static_cast<std::int64_t>(1000 + i))));
  }
  EXPECT_FALSE(queue.push(scopeAt(0, 999999)));
  EXPECT_TRUE(queue.push(buttonsAt(1, 999999)));
  apply(1000);
  EXPECT_TRUE(queue.push(scopeAt(0, 999999)));
}

TEST_F(InputQueueTest, lockstepKnowsATimeWhenEveryChannelHasReachedIt) {
  EXPECT_FALSE(queue.knownUntil(100));
  queue.push(scopeAt(0, 100));
  queue.push(suturingDeviceAt(0, 105));
  EXPECT_EQ(queue.missingAt(100), "scope/buttons");
  queue.push(buttonsAt(0, 99));
  EXPECT_FALSE(queue.knownUntil(100));
  queue.push(buttonsAt(0, 100));
  EXPECT_TRUE(queue.knownUntil(100));
  EXPECT_FALSE(queue.knownUntil(101));
  EXPECT_EQ(queue.missingAt(101), "scope/input/joint_states, scope/buttons");
  // applying does not make it forget what it knows
  apply(100);
  EXPECT_TRUE(queue.knownUntil(100));
  queue.clear();
  EXPECT_FALSE(queue.knownUntil(100));
}

TEST_F(InputQueueTest, buttonsThatNobodyPressesAnyMoreAreReleasedAndTheScopeStays) {
  queue.push(buttonsAt(1, 1000));
  queue.push(scopeAt(0.1, 1000));
  EXPECT_TRUE(apply(1000).empty());
  EXPECT_TRUE(apply(1000 + kButtonTimeout).empty());
  EXPECT_EQ(input.buttons[HelixGrab], 1);
  const std::vector<std::string> sentences = apply(1001 + kButtonTimeout);
  ASSERT_EQ(sentences.size(), 1u);
  EXPECT_NE(sentences[0].find("scope/buttons"), std::string::npos);
  EXPECT_NE(sentences[0].find("are released: helix_grab;"), std::string::npos);
  EXPECT_EQ(input.buttons[HelixGrab], 0);
  EXPECT_EQ(input.joints[Insertion], 0.1);
  EXPECT_TRUE(apply(5000 + kButtonTimeout).empty()) << "said once";
  queue.push(buttonsAt(1, 0));
  apply(6000 + kButtonTimeout);
  EXPECT_EQ(input.buttons[HelixGrab], 1);
}

TEST_F(InputQueueTest, noPressIsLostBetweenTwoSteps) {
  queue.push(buttonsAt(1, 11));
  queue.push(buttonsAt(0, 15));
  apply(20);
  EXPECT_EQ(input.buttons[HelixGrab], 1);
  apply(30);
  EXPECT_EQ(input.buttons[HelixGrab], 0);
  apply(40);
  EXPECT_EQ(input.buttons[HelixGrab], 0);
  queue.push(buttonsAt(1, 41));
  apply(50);
  queue.push(buttonsAt(0, 51));
  queue.push(buttonsAt(1, 52));
  apply(60);
  EXPECT_EQ(input.buttons[HelixGrab], 0) << "let go and pressed again";
  apply(70);
  EXPECT_EQ(input.buttons[HelixGrab], 1);
}

TEST_F(InputQueueTest, buttonsStayPressedWhereTimeIsNotThatOfTheWall) {
  queue.push(buttonsAt(1, 1000));
  apply(1000, false);
  EXPECT_TRUE(apply(9 * kButtonTimeout, false).empty());
  EXPECT_EQ(input.buttons[HelixGrab], 1);
}

TEST_F(InputQueueTest, buttonsThatAreNotPressedMayBeSilent) {
  queue.push(buttonsAt(0, 1000));
  apply(1000);
  EXPECT_TRUE(apply(5 * kButtonTimeout).empty());
}

TEST_F(InputQueueTest, aPressThatIsToEndLaterIsNotSilent) {
  queue.push(buttonsAt(1, 1000));
  queue.push(buttonsAt(0, 9 * kButtonTimeout));
  apply(1000);
  EXPECT_TRUE(apply(8 * kButtonTimeout).empty());
  EXPECT_EQ(input.buttons[HelixGrab], 1);
}

TEST_F(InputQueueTest, aClockThatIsSetBackLocksNobodyOut) {
  const std::int64_t hour = 3600LL * 1'000'000'000;
  apply(2 * hour);
  queue.push(scopeAt(0.1, 2 * hour + 1));
  apply(hour);
  EXPECT_EQ(input.joints[Insertion], 0.1) << "what waited is due";
  queue.push(scopeAt(0.2, hour + 100));
  apply(hour + 99);
  EXPECT_EQ(input.joints[Insertion], 0.1);
  apply(hour + 100);
  EXPECT_EQ(input.joints[Insertion], 0.2);
}

class PullQueueTest : public testing::Test {
 protected:
  test::World world{test::bareScene(), test::plainOrgan(test::icosphere(0.05, 2), 2e-3)};
  InputQueue queue;
  InputInterpreter interpreter;
  StepInput input;
  std::vector<std::string> apply(std::int64_t stamp) {
    return interpreter.interpret(queue.takeDue(stamp), *world.model, input);
  }
};

TEST_F(PullQueueTest, aPullIsLatchedLikeEveryInput) {
  queue.push(pullAt(3, 0.01, 100));
  queue.push(pullAt(3, 0.02, 200));
  queue.push(pullAt(-1, 0.03, 300));
  EXPECT_TRUE(apply(99).empty());
  EXPECT_EQ(input.pull_particle, -1);
  apply(150);
  EXPECT_EQ(input.pull_particle, 3);
  EXPECT_EQ(input.pull_target.x(), 0.01);
  apply(299);
  EXPECT_EQ(input.pull_target.x(), 0.02);
  apply(300);
  EXPECT_EQ(input.pull_particle, -1);
  EXPECT_TRUE(input.pull_target.isZero());
}

TEST_F(PullQueueTest, aSilentHandLetsGoAndSaysSoOnce) {
  queue.push(pullAt(3, 0.01, 1000));
  apply(1000);
  EXPECT_TRUE(apply(1000 + kPullTimeout).empty());
  EXPECT_EQ(input.pull_particle, 3);
  const std::vector<std::string> sentences = apply(1001 + kPullTimeout);
  ASSERT_EQ(sentences.size(), 1u);
  EXPECT_NE(sentences[0].find("tissue/pull"), std::string::npos);
  EXPECT_EQ(input.pull_particle, -1);
  EXPECT_TRUE(apply(2000 + kPullTimeout).empty());
  queue.push(pullAt(3, 0.01, 0));  // without a stamp it counts from when it came
  apply(3000 + kPullTimeout);
  EXPECT_EQ(input.pull_particle, 3);
  EXPECT_TRUE(apply(2000 + 2 * kPullTimeout).empty());
  EXPECT_EQ(input.pull_particle, 3);
}

TEST_F(PullQueueTest, aPullFromBeforeTheFirstStepCountsAsOfThatStep) {
  queue.push(pullAt(3, 0.01, 0));
  EXPECT_TRUE(apply(3 * kPullTimeout).empty());
  EXPECT_EQ(input.pull_particle, 3);
}

TEST_F(PullQueueTest, aParticleThatDoesNotExistIsASentenceAndLetsGo) {
  queue.push(pullAt(3, 0.01, 1));
  apply(1);
  queue.push(pullAt(world.model->particle_count, 0.01, 2));
  const std::vector<std::string> sentences = apply(2);
  ASSERT_EQ(sentences.size(), 1u);
  EXPECT_NE(sentences[0].find(std::to_string(world.model->particle_count)), std::string::npos);
  EXPECT_EQ(input.pull_particle, -1);
}

TEST_F(PullQueueTest, lockstepDoesNotWaitForAHand) {
  queue.push(scopeAt(0, 100));
  queue.push(suturingDeviceAt(0, 100));
  EXPECT_FALSE(queue.knownUntil(100));
  queue.push(buttonsAt(0, 100));
  EXPECT_TRUE(queue.knownUntil(100));
  EXPECT_EQ(queue.missingAt(101).find("tissue/pull"), std::string::npos);
}

TEST_F(InputQueueTest, aTipTargetWithoutAScopeIsReportedAndChangesNothing) {
  InputSample sample = scopeAt(0, 1);
  sample.target = ScopeTarget::TipInWorld;
  queue.push(sample);
  input.joints[Insertion] = 0.05;
  const std::vector<std::string> sentences = apply(1);
  ASSERT_EQ(sentences.size(), 1u);
  EXPECT_NE(sentences[0].find("no scope"), std::string::npos);
  EXPECT_EQ(input.joints[Insertion], 0.05);
}

}  // namespace
}  // namespace vibe::sim::input_queue_test
