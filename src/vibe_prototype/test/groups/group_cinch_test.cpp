// The cinch where the scene pulls by groups.
#include <gtest/gtest.h>

#include "procedure/procedure_bench.hpp"

namespace vibe::prototype::group_cinch_test {
namespace {

using Kind = Event::Kind;

/// Two bites on the ball, the T-tag dropped.
test::Bench tagged(const std::string& pulling) {
  Scene scene = test::benchScene();
  scene.suture->cinch_model = pulling;
  test::Bench bench(scene);
  bench.bite(0);
  bench.bite(1);
  bench.press(TTag);
  return bench;
}

TEST(GroupCinch, FindsTheGroupOnceAndDrawsItAtTheSpeedOfTheCinch) {
  test::Bench bench = tagged("groups");
  ASSERT_EQ(bench.count(Kind::TTagDropped), 1);
  Suture& suture = bench.procedure().sutures.back();
  EXPECT_TRUE(suture.group.empty()) << "not before the cinch";
  bench.hold(Cinch);
  ASSERT_EQ(bench.count(Kind::CinchPulling), 1);
  ASSERT_FALSE(suture.group.empty());
  const std::vector<int> particles = suture.group.particle;
  const double frame = bench.model().scene.suture->cinch_speed * bench.model().scene.step_period;
  EXPECT_NEAR(suture.pulled, frame, 1e-12);
  for (int k = 0; k < 5; ++k) bench.hold(Cinch);
  EXPECT_NEAR(suture.pulled, 6 * frame, 1e-12);
  EXPECT_GT(suture.group.drawn, 0);
  EXPECT_EQ(suture.group.particle, particles);
  const double drawn = suture.group.drawn;
  suture.tension.front() = bench.model().scene.suture->cinch_tension;
  bench.hold(Cinch);
  EXPECT_EQ(suture.group.drawn, drawn) << "tight enough";
  bench.hold(Cinch, false);
  EXPECT_EQ(bench.count(Kind::Cinched), 1);
  EXPECT_NE(describe(bench.events.front()).find("the wall was drawn by"), std::string::npos);
  EXPECT_EQ(suture.stage, Suture::Stage::Cinched);
  EXPECT_EQ(suture.group.drawn, drawn) << "permanent";
}

TEST(GroupCinch, DoesNotDrawAWallAtItsStrainLimit) {
  test::Bench bench = tagged("groups");
  bench.hold(Cinch);
  Suture& suture = bench.procedure().sutures.back();
  const double drawn = suture.group.drawn;
  for (double& x : bench.state().x) x *= 1.6;
  bench.hold(Cinch);
  EXPECT_EQ(suture.group.drawn, drawn);
  for (double& x : bench.state().x) x /= 1.6;
  bench.hold(Cinch);
  EXPECT_GT(suture.group.drawn, drawn);
}

TEST(GroupCinch, ThreadHasNoGroup) {
  test::Bench bench = tagged("thread");
  bench.hold(Cinch);
  EXPECT_EQ(bench.count(Kind::CinchPulling), 1);
  EXPECT_TRUE(bench.procedure().sutures.back().group.empty());
}

}  // namespace
}  // namespace vibe::prototype::group_cinch_test
