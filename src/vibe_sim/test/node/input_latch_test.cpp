#include "input_latch.hpp"

#include <gtest/gtest.h>

#include "worlds.hpp"

namespace vibe {
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

InputSample overstitchAt(double advance, std::int64_t stamp) {
  InputSample sample;
  sample.channel = InputChannel::Overstitch;
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

class InputLatchTest : public testing::Test {
 protected:
  InputLatch latch;
  Model model;  // without a tool
  StepInput input;
};

TEST_F(InputLatchTest, futureSamplesWaitUntilTheyAreDue) {
  latch.push(scopeAt(0.1, 100));
  latch.push(scopeAt(0.2, 200));
  latch.apply(99, model, input);
  EXPECT_EQ(input.joints[Insertion], 0.0);
  latch.apply(100, model, input);
  EXPECT_EQ(input.joints[Insertion], 0.1);
  latch.apply(1000, model, input);
  EXPECT_EQ(input.joints[Insertion], 0.2);
}

TEST_F(InputLatchTest, lastValueStaysInForce) {
  latch.push(buttonsAt(1, 10));
  latch.apply(10, model, input);
  latch.apply(20, model, input);
  EXPECT_EQ(input.buttons[HelixGrab], 1);
}

TEST_F(InputLatchTest, stampZeroAndThePastCountAsNowInTheOrderOfArrival) {
  latch.apply(500, model, input);
  latch.push(scopeAt(0.1, 400));
  latch.push(scopeAt(0.2, 0));
  latch.push(scopeAt(0.3, 300));
  latch.apply(501, model, input);
  EXPECT_EQ(input.joints[Insertion], 0.3);
}

TEST_F(InputLatchTest, samplesOutOfOrderAreAppliedInTheOrderOfStamps) {
  latch.push(scopeAt(0.3, 300));
  latch.push(scopeAt(0.1, 100));
  latch.push(scopeAt(0.2, 200));
  latch.apply(250, model, input);
  EXPECT_EQ(input.joints[Insertion], 0.2);
}

TEST_F(InputLatchTest, aRepeatedStampReplacesWhatWaits) {
  for (int i = 0; i < 10000; ++i) EXPECT_TRUE(latch.push(scopeAt(0.001 * i, 100)));
  latch.apply(100, model, input);
  EXPECT_DOUBLE_EQ(input.joints[Insertion], 9.999);
}

TEST_F(InputLatchTest, channelsTouchTheirOwnValuesOnly) {
  input.joints = {1, 2, 3, 4, 5, 6, 7};
  latch.push(overstitchAt(0.01, 1));
  latch.apply(1, model, input);
  EXPECT_EQ(input.joints, (std::array<double, kJointCount>{1, 2, 3, 4, 0.01, 0, 0}));
  latch.push(scopeAt(0.02, 2));
  latch.apply(2, model, input);
  EXPECT_EQ(input.joints, (std::array<double, kJointCount>{0.02, 0, 0, 0, 0.01, 0, 0}));
}

TEST_F(InputLatchTest, aFullChannelRefusesAndTheOthersDoNotCare) {
  for (std::size_t i = 0; i < InputLatch::kCapacity; ++i) {
    ASSERT_TRUE(latch.push(scopeAt(0, static_cast<std::int64_t>(1000 + i))));
  }
  EXPECT_FALSE(latch.push(scopeAt(0, 999999)));
  EXPECT_TRUE(latch.push(buttonsAt(1, 999999)));
  latch.apply(1000, model, input);
  EXPECT_TRUE(latch.push(scopeAt(0, 999999)));
}

TEST_F(InputLatchTest, lockstepKnowsATimeWhenEveryChannelHasReachedIt) {
  EXPECT_FALSE(latch.knownUntil(100));
  latch.push(scopeAt(0, 100));
  latch.push(overstitchAt(0, 105));
  EXPECT_EQ(latch.missingAt(100), "scope/buttons");
  latch.push(buttonsAt(0, 99));
  EXPECT_FALSE(latch.knownUntil(100));
  latch.push(buttonsAt(0, 100));
  EXPECT_TRUE(latch.knownUntil(100));
  EXPECT_FALSE(latch.knownUntil(101));
  EXPECT_EQ(latch.missingAt(101), "scope/measured_js, scope/buttons");
  // applying does not make it forget what it knows
  latch.apply(100, model, input);
  EXPECT_TRUE(latch.knownUntil(100));
  latch.clear();
  EXPECT_FALSE(latch.knownUntil(100));
}

class PullLatchTest : public testing::Test {
 protected:
  test::World world{test::bareScene(), test::plainOrgan(test::icosphere(0.05, 2), 2e-3)};
  InputLatch latch;
  StepInput input;
  std::vector<std::string> apply(std::int64_t stamp) { return latch.apply(stamp, *world.model, input); }
};

TEST_F(PullLatchTest, aPullIsLatchedLikeEveryInput) {
  latch.push(pullAt(3, 0.01, 100));
  latch.push(pullAt(3, 0.02, 200));
  latch.push(pullAt(-1, 0.03, 300));
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

TEST_F(PullLatchTest, aSilentHandLetsGoAndSaysSoOnce) {
  latch.push(pullAt(3, 0.01, 1000));
  apply(1000);
  EXPECT_TRUE(apply(1000 + kHandPatience).empty());
  EXPECT_EQ(input.pull_particle, 3);
  const std::vector<std::string> sentences = apply(1001 + kHandPatience);
  ASSERT_EQ(sentences.size(), 1u);
  EXPECT_NE(sentences[0].find("tissue/pull"), std::string::npos);
  EXPECT_EQ(input.pull_particle, -1);
  EXPECT_TRUE(apply(2000 + kHandPatience).empty());
  latch.push(pullAt(3, 0.01, 0));  // without a stamp it counts from when it came
  apply(3000 + kHandPatience);
  EXPECT_EQ(input.pull_particle, 3);
  EXPECT_TRUE(apply(2000 + 2 * kHandPatience).empty());
  EXPECT_EQ(input.pull_particle, 3);
}

TEST_F(PullLatchTest, aPullFromBeforeTheFirstStepCountsAsOfThatStep) {
  latch.push(pullAt(3, 0.01, 0));
  EXPECT_TRUE(apply(3 * kHandPatience).empty());
  EXPECT_EQ(input.pull_particle, 3);
}

TEST_F(PullLatchTest, aParticleThatDoesNotExistIsASentenceAndLetsGo) {
  latch.push(pullAt(3, 0.01, 1));
  apply(1);
  latch.push(pullAt(world.model->particle_count, 0.01, 2));
  const std::vector<std::string> sentences = apply(2);
  ASSERT_EQ(sentences.size(), 1u);
  EXPECT_NE(sentences[0].find(std::to_string(world.model->particle_count)), std::string::npos);
  EXPECT_EQ(input.pull_particle, -1);
}

TEST_F(PullLatchTest, lockstepDoesNotWaitForAHand) {
  latch.push(scopeAt(0, 100));
  latch.push(overstitchAt(0, 100));
  EXPECT_FALSE(latch.knownUntil(100));
  latch.push(buttonsAt(0, 100));
  EXPECT_TRUE(latch.knownUntil(100));
  EXPECT_EQ(latch.missingAt(101).find("tissue/pull"), std::string::npos);
}

TEST_F(InputLatchTest, aTipTargetWithoutAScopeIsReportedAndChangesNothing) {
  InputSample sample = scopeAt(0, 1);
  sample.target = ScopeTarget::TipInWorld;
  latch.push(sample);
  input.joints[Insertion] = 0.05;
  const std::vector<std::string> sentences = latch.apply(1, model, input);
  ASSERT_EQ(sentences.size(), 1u);
  EXPECT_NE(sentences[0].find("no scope"), std::string::npos);
  EXPECT_EQ(input.joints[Insertion], 0.05);
}

}  // namespace
}  // namespace vibe
