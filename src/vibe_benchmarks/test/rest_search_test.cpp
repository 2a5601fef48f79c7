// The detector of walls that do not rest, on motions that are known.
#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "contact/rest_search.hpp"
#include "vibe_core/builder/model_builder.hpp"
#include "vibe_core/files/files.hpp"
#include "vibe_core/scene/scene_parser.hpp"
#include "vibe_core/solver/step_policy.hpp"

namespace vibe::benchmarks::rest_search_test {
namespace {

constexpr double kStep = 1.0 / 60;
constexpr int kSteps = 60;

/// Of two particles of which one stands.
template <class Motion>
RestDetector seen(Motion motion) {
  RestDetector detector(kStep);
  for (int k = 0; k < kSteps; ++k) {
    State state;
    state.x = {0, 0.1 + motion(k)};
    state.y = state.z = {0, 0};
    detector.add(state);
  }
  return detector;
}

TEST(RestDetector, StandsStill) {
  const RestDetector still = seen([](int) { return 0.0; });
  EXPECT_EQ(still.wall(), HeldWall::Rests);
  EXPECT_EQ(still.motion(), 0);
  EXPECT_EQ(seen([](int k) { return 1e-7 * (k % 2); }).wall(), HeldWall::Rests) << "6 um/s";
}

TEST(RestDetector, ALimitCycleHasAPeriodAndAnAmplitude) {
  for (const int period : {2, 3, 12}) {
    const RestDetector cycle = seen([&](int k) { return 1e-3 * std::sin(2 * M_PI * k / period + 0.3); });
    EXPECT_EQ(cycle.wall(), HeldWall::Trembles) << period;
    EXPECT_EQ(cycle.period(), period);
    EXPECT_GT(cycle.motion(), 0.5e-3);
    EXPECT_LT(cycle.motion(), 2.001e-3);
  }
  EXPECT_EQ(seen([](int k) { return 1e-3 * std::sin(0.02 * k * k); }).period(), 0) << "none that repeats";
}

TEST(RestDetector, WhatGoesOneWayCreeps) {
  const RestDetector creeps = seen([](int k) { return 1e-6 * k; });
  EXPECT_EQ(creeps.wall(), HeldWall::Creeps);
  EXPECT_EQ(creeps.period(), 0);
  EXPECT_NEAR(creeps.drift(), 40e-6, 1e-9);
  EXPECT_NEAR(creeps.speed(), 60e-6, 1e-9);
}

/// How many of 13 poses leave the wall of a coarse stomach so. In one of them a triangle is stretched until it needs
/// more points.
std::map<HeldWall, int> heldPoses(double hold, const StepPolicy& policy = stepPolicy()) {
  const ScopedStepPolicy scoped(policy);
  Scene scene = loadScene(resolveAddress("package://vibe_core/scenes/stomach.yaml"));
  scene.geometry.particles = 300;
  const auto model = buildModel(scene, readTextFile(resolveAddress(scene.scope->urdf), "URDF"));
  std::map<HeldWall, int> count;
  searchRest(model, 13, 1, hold, [&](const HeldPose& pose) { ++count[pose.wall]; });
  return count;
}

TEST(HeldPoses, TheWallRestsUnderAScopeThatIsHeld) {
  EXPECT_EQ(heldPoses(6)[HeldWall::Rests], 13);
}

// Where contacts are found anew in every step, as while the hand moves, few walls tremble because those that come or go
// have no force.
TEST(HeldPoses, ContactsThatComeAndGoHaveNoForce) {
  StepPolicy policy = stepPolicy();
  policy.hold_time = 1e9;
  EXPECT_EQ(heldPoses(2, policy)[HeldWall::Trembles], 0);
  policy.touch_fade_in = 1e-3;  // contacts of stretched edges come with all of their force
  policy.touch_corner = 0;      // and those of corners go with it
  EXPECT_GT(heldPoses(2, policy)[HeldWall::Trembles], 0) << "what this guards against is seen";
}

}  // namespace
}  // namespace vibe::benchmarks::rest_search_test
