// Contacts that stay as they were found while the hand holds.
#include "tool_contact/contact_memory.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "simulation/state_check.hpp"
#include "tool_contact/sheet_scene.hpp"
#include "vibe_core/scene/scene_parser.hpp"
#include "vibe_testing/scope_fixture.hpp"
#include "vibe_testing/worlds.hpp"

namespace vibe::contact_memory_test {
namespace {

using Eigen::Vector3d;
using namespace test::sheet;

constexpr double kRadius = 1e-4;  // of the ball [m]

/// A tip before a sheet, and what is kept of its contacts.
struct Held {
  Held() : scene(8e-3, 10), memory(scene.tool) {
    state.x = scene.start[0], state.y = scene.start[1], state.z = scene.start[2];
    poses.start.poses = poses.end.poses = scene.posesAt({-1e-3, 0, 0});
  }
  std::vector<SurfaceContact> found() {
    const Points now{state.x, state.y, state.z};
    return scene.contacts.find(poses.start, poses.end, pathOf(now, now), 0.5e-3, scene.none);
  }
  std::vector<SurfaceContact> recall() {
    const auto result = memory.recall(found(), poses, state, kRadius, scene.none);
    state.hold.contacts = memory.kept();
    return result;
  }
  void moveWall(const Vector3d& by) {
    for (std::size_t i = 0; i < state.x.size(); ++i) state.x[i] += by.x(), state.y[i] += by.y(), state.z[i] += by.z();
  }

  SheetScene scene;
  ContactMemory memory;
  State state;
  ToolPoses poses;
};

double farthestTurn(const std::vector<SurfaceContact>& one, const std::vector<SurfaceContact>& other) {
  double most = 0;
  for (const SurfaceContact& a : one)
    for (const SurfaceContact& b : other)
      if (a.point.node == b.point.node && a.shape == b.shape) most = std::max(most, (a.normal - b.normal).norm());
  return most;
}

TEST(ContactMemory, AContactStaysUntilItsPointHasLeftTheBall) {
  Held held;
  const auto first = held.recall();
  ASSERT_GT(first.size(), 4U);
  held.moveWall({0, 0.9 * kRadius, 0});
  EXPECT_GT(farthestTurn(first, held.found()), 1e-3) << "found anew, normals turn";
  EXPECT_EQ(farthestTurn(first, held.recall()), 0);
  held.moveWall({0, 0.2 * kRadius, 0});
  const auto found = held.found(), anew = held.recall();
  EXPECT_EQ(farthestTurn(found, anew), 0);
  EXPECT_GT(farthestTurn(first, anew), 1e-3);
}

TEST(ContactMemory, KeptContactsGoWithTheirLink) {
  Held held;
  const auto first = held.recall();
  const Eigen::AngleAxisd turn(0.3, Vector3d(1, 2, 3).normalized());
  const Vector3d shift(0.01, -0.02, 0.03);
  for (auto* poses : {&held.poses.start.poses, &held.poses.end.poses})
    for (Eigen::Isometry3d& pose : *poses) pose = Eigen::Translation3d(shift) * turn * pose;
  for (std::size_t i = 0; i < held.state.x.size(); ++i) {
    const Vector3d p = turn * Vector3d(held.state.x[i], held.state.y[i], held.state.z[i]) + shift;
    held.state.x[i] = p.x(), held.state.y[i] = p.y(), held.state.z[i] = p.z();
  }
  const auto& turned = held.memory.recall({}, held.poses, held.state, kRadius, held.scene.none);
  ASSERT_EQ(turned.size(), first.size()) << "what is no longer found stays as well";
  for (std::size_t c = 0; c < first.size(); ++c) {
    EXPECT_LT((turned[c].normal - turn * first[c].normal).norm(), 1e-12);
    EXPECT_LT((turned[c].tool_point - (turn * first[c].tool_point + shift)).norm(), 1e-12);
  }
}

TEST(ContactMemory, WhatTheHelixTakesIsNotKept) {
  Held held;
  const auto first = held.recall();
  std::vector<char> excluded = held.scene.none;
  excluded[static_cast<std::size_t>(first[0].point.node[0])] = kHeld;
  EXPECT_EQ(held.memory.recall({}, held.poses, held.state, kRadius, excluded).size(), first.size() - 1);
}

// Nearest points have other weights in every step, and still are one contact.
TEST(ContactMemory, ANearestPointIsOnePointThatMoves) {
  Held held;
  SurfaceContact nearest = held.found()[0];
  nearest.point = {3, {0, 1, 2}, {0.5, 0.3, 0.2}};
  nearest.nearest = true;
  held.memory.recall({nearest}, held.poses, held.state, kRadius, held.scene.none);
  held.state.hold.contacts = held.memory.kept();
  SurfaceContact other = nearest;
  other.point.weight = {0.5, 0.31, 0.19};
  EXPECT_EQ(held.memory.recall({other}, held.poses, held.state, kRadius, held.scene.none).size(), 1U);
  other.nearest = false;
  EXPECT_EQ(held.memory.recall({other}, held.poses, held.state, kRadius, held.scene.none).size(), 2U);
}

/// A scope that is held against the wall of a coarse stomach.
struct Press {
  Press() : model(makeModel()), state(initialState(*model, 1)), workspace(std::make_unique<Workspace>(*model)) {
    for (int k = 1; k <= 90; ++k) {
      input.joints = {k / 90.0 * 0.29, k / 90.0 * 2.75, k / 90.0 * -0.69, k / 90.0 * -0.89};
      advance();
    }
  }
  static std::shared_ptr<const Model> makeModel() {
    Scene scene = loadScene(std::string(VIBE_CORE_DIR) + "/scenes/stomach.yaml");
    scene.geometry.particles = 300;
    scene.render_surface = false;
    return buildModel(scene, scopeText());
  }
  void advance() { step(*model, state, input, *workspace, events); }

  std::shared_ptr<const Model> model;
  State state;
  std::unique_ptr<Workspace> workspace;
  StepInput input;
  std::vector<Event> events;
};

TEST(ContactMemory, BeginsWithAHandThatHoldsAndEndsWithItsMotion) {
  Press press;
  EXPECT_EQ(press.state.hold.steps, 0);
  for (int k = 0; k < 200 && press.state.hold.contacts.empty(); ++k) press.advance();
  ASSERT_FALSE(press.state.hold.contacts.empty());
  const State kept = press.state;
  press.advance();
  const std::uint64_t after = hash(press.state);
  press.state = kept;
  press.workspace = std::make_unique<Workspace>(*press.model);
  press.advance();
  EXPECT_EQ(hash(press.state), after) << "it is all in the state";
  const auto damaged = [&](const std::function<void(HoldMemory&)>& damage) {
    State state = kept;
    damage(state.hold);
    return !findDamage(state, *press.model).empty();
  };
  EXPECT_FALSE(damaged([](HoldMemory&) {}));
  EXPECT_TRUE(damaged([](HoldMemory& hold) { hold.contacts[0].node[1] = -7; }));
  EXPECT_TRUE(damaged([](HoldMemory& hold) { hold.contacts[0].weight[2] = NAN; }));
  EXPECT_TRUE(damaged([](HoldMemory& hold) { hold.contacts[0].shape = 99; }));
  EXPECT_TRUE(damaged([](HoldMemory& hold) { hold.steps = -1; }));
  press.state = kept;
  press.state.hold = {};
  press.advance();
  EXPECT_NE(hash(press.state), after);
  press.input.joints[Insertion] += 1e-6;
  press.advance();
  EXPECT_EQ(press.state.hold.steps, 0);
  EXPECT_TRUE(press.state.hold.contacts.empty());
}

}  // namespace
}  // namespace vibe::contact_memory_test
