// A needle that is thinner than the particles are apart, and faster than a hand: the wall gives way or the needle
// stops, but it never comes out on the other side.
#include <gtest/gtest.h>

#include <cmath>

#include "tool_contact/shape_distance.hpp"
#include "tool_contact/thin_tool.hpp"
#include "tool_contact/tool_collision.hpp"
#include "vibe_testing/scope_worlds.hpp"

namespace vibe::thin_tool_test {
namespace {

using test::World;

constexpr double kRadius = 0.05, kNeedle = 0.4e-3, kLength = 0.01;

/// A ball of 7.6 mm between particles, and a needle that enters at the top and points down, tilted by `tilt`.
World needleWorld(double speed, double tilt) {
  Scene scene;
  scene.foundation = FoundationScene{};
  scene.scope = test::scopeFromAbove(kRadius);
  scene.scope->base_rpy[1] += tilt;
  return World(scene, test::openBall(kRadius, 3, 2e-3, 0.8), test::thinToolText(kNeedle, kLength, speed));
}

std::vector<Eigen::Isometry3d> posesOf(const World& world) {
  std::vector<Eigen::Isometry3d> poses;
  world.model->tool->forwardKinematics(world.state.joints, poses);
  for (Eigen::Isometry3d& pose : poses) pose = world.model->tool_base * pose;
  return poses;
}

bool piercesWall(const World& world) {
  const Eigen::Isometry3d tip = posesOf(world)[world.model->tip_link];
  const auto& end = world.model->organ.end;
  for (const auto& n : world.model->organ.surface.triangles) {
    if (end[n[0]] != End::None || end[n[1]] != End::None || end[n[2]] != End::None) continue;
    const std::array<Eigen::Vector3d, 3> t{world.position(n[0]), world.position(n[1]), world.position(n[2])};
    if (segmentTriangleGap(tip.translation(), tip * Eigen::Vector3d(kLength, 0, 0), t).distance == 0) return true;
  }
  return false;
}

// The closed surface winds once around what is inside: sum of the solid angles of its triangles (Van Oosterom, Strackee
// 1983, doi 10.1109/TBME.1983.325207).
bool isBeyondWall(const World& world) {
  const Eigen::Vector3d front = posesOf(world)[world.model->tip_link] * Eigen::Vector3d(kLength, 0, 0);
  double angle = 0;
  for (const auto& n : world.model->organ.surface.triangles) {
    const Eigen::Vector3d a = world.position(n[0]) - front, b = world.position(n[1]) - front,
                          c = world.position(n[2]) - front;
    const double la = a.norm(), lb = b.norm(), lc = c.norm();
    angle += 2 * std::atan2(a.dot(b.cross(c)), la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb);
  }
  return angle < 2 * M_PI;
}

/// Whether a test of particles alone would see the needle.
bool particleInReach(const World& world) {
  ToolCollision collision(*world.model->tool);
  const State& s = world.state;
  const double reach = world.model->particle_radius + 0.5e-3;
  collision.findCandidates(posesOf(world), s.x.data(), s.y.data(), s.z.data(), world.model->particle_count, reach);
  return collision.candidateCount() > 0;
}

class Needle : public ::testing::TestWithParam<double> {};

TEST_P(Needle, NeverPassesTheWall) {
  int unseen = 0;
  for (const double tilt : {0.0, -0.31, 0.52}) {
    World world = needleWorld(GetParam(), tilt);
    StepInput input;
    input.joints[Insertion] = 0.3;  // far beyond the ball
    input.joints[TipUpDown] = 0.4 * tilt;
    for (int i = 0; i < 60; ++i) {
      world.step(input);
      ASSERT_FALSE(piercesWall(world)) << "tilt " << tilt << ", step " << i;
      ASSERT_FALSE(isBeyondWall(world)) << "tilt " << tilt << ", step " << i;
      unseen += world.state.contact_count > 0 && !particleInReach(world) ? 1 : 0;
    }
    EXPECT_TRUE(world.state.contact_count > 0 || world.state.joints[Insertion] < 0.3) << "it has met the wall";
  }
  if (GetParam() < 0.5) {
    EXPECT_GT(unseen, 0) << "particles alone would have let it pass";
  }
}

INSTANTIATE_TEST_SUITE_P(Speeds, Needle, ::testing::Values(0.12, 1.0, 5.0));

// Contacts that the solver has resolved leave nothing to the guard behind them: the scope is where the hand puts it.
TEST(ScopeOnWall, FollowsTheHandWhileItPresses) {
  World world = needleWorld(0.15, 0);
  world = World(world.model->scene, world.model->organ, scopeText());
  StepInput input;
  input.joints[Insertion] = 0.08;
  world.run(1, input);
  double most = 0;
  for (int k = 0; k < 240; ++k) {
    const double moved = k < 120 ? 4e-4 : 0;  // 24 mm/s, then still
    input.joints[Insertion] += moved;
    input.joints[TipUpDown] += moved;
    world.step(input);
    ASSERT_EQ(world.state.joints[Insertion], input.joints[Insertion]) << "step " << k;
    ASSERT_EQ(world.state.joints[TipUpDown], input.joints[TipUpDown]) << "step " << k;
    for (const int stalls : world.state.stall) ASSERT_EQ(stalls, 0);
    most = std::max(most, world.state.tool_force.norm());
  }
  EXPECT_GT(most, 0.5) << "N";
}

}  // namespace
}  // namespace vibe::thin_tool_test
