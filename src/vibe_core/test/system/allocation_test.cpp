// A step asks for no memory once a session has settled in: with gas, walls that may meet, a grip and contacts.
#include "vibe_testing/allocation_count.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "vibe_testing/scope_worlds.hpp"

namespace vibe::allocation_test {
namespace {

using test::World;

constexpr double kRadius = 0.06;
constexpr int kCycle = 60;  // steps

World sessionWorld() {
  Scene scene;
  scene.tissue.model = "shell";
  scene.tissue.self_contact = true;
  scene.foundation = FoundationScene{};
  scene.gas = GasScene{};
  scene.gas->initial_pressure = 800;
  scene.scope = test::scopeFromAbove(kRadius);
  scene.helix = test::wideHelix();
  return test::scopeWorld(scene, test::openBall(kRadius, 4, 2.3e-3));
}

// The helix draws what it holds to the tip, which comes to touch the wall, and lets it go half of the way again.
StepInput inputAt(int step) {
  const double part = 0.5 * (1 - std::cos(2 * M_PI * step / kCycle));
  StepInput input;
  input.joints[Insertion] = 0.1 + 0.04 * part;
  input.joints[HelixAdvance] = 0.028 * (1 - part);
  input.buttons[HelixGrab] = 1;
  return input;
}

long allocationsOf(World& world, const StepInput& input) {
  const long before = test::allocations;
  world.step(input);
  return test::allocations - before;
}

class Allocation : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!VIBE_COUNTS_ALLOCATIONS) GTEST_SKIP() << "a sanitizer brings its own memory";
  }
};

TEST_F(Allocation, IsCounted) {
  const long before = test::allocations;
  const std::vector<double> made(7);
  EXPECT_EQ(test::allocations - before, 1);
  const Eigen::VectorXd made_too = Eigen::VectorXd::Zero(7);
  EXPECT_EQ(test::allocations - before, 2);
  EXPECT_EQ(static_cast<Eigen::Index>(made.size()), made_too.size());
  World world = sessionWorld();
  EXPECT_GT(allocationsOf(world, {}), 10) << "the first step makes its memory";
}

TEST_F(Allocation, SettledStepsHaveNone) {
  World world = sessionWorld();
  StepInput approach = inputAt(0);
  approach.buttons[HelixGrab] = 0;
  world.run(1.5, approach);
  world.events.reserve(1000);
  for (int i = 0; i < 2 * kCycle; ++i) world.step(inputAt(i));
  ASSERT_GT(world.state.grip.size(), 5u);

  // In motion nodes come to the tool for the first time, the number of contacts changes, and every few steps a thread
  // is started that makes the next factor: these ask for a little.
  std::vector<long> counts;
  int touching = 0;
  for (int i = 0; i < kCycle; ++i) {
    counts.push_back(allocationsOf(world, inputAt(i)));
    touching += world.state.contact_count > 0 ? 1 : 0;
  }
  EXPECT_GT(touching, 5);
  std::sort(counts.begin(), counts.end());
  EXPECT_EQ(counts[counts.size() / 2], 0);
  EXPECT_LT(counts.back(), 50);

  // the first steps of a hand that holds make the memory of what it keeps
  for (int i = 0; i < 2 * kCycle; ++i) world.step(inputAt(kCycle / 2));
  ASSERT_FALSE(world.state.hold.contacts.empty());
  ASSERT_GT(world.state.contact_count, 0);
  ASSERT_FALSE(world.state.grip.empty());
  for (int i = 0; i < kCycle; ++i) ASSERT_EQ(allocationsOf(world, inputAt(kCycle / 2)), 0) << "held still, step " << i;
}

}  // namespace
}  // namespace vibe::allocation_test
