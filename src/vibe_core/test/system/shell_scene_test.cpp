// The shell and the implicit solver in a whole scene: gas, weight, determinism, snapshots.
#include <gtest/gtest.h>

#include <cstdio>

#include "geometry/surface_operators.hpp"
#include "vibe_core/constraints/gas.hpp"
#include "vibe_core/simulation/snapshot.hpp"
#include "vibe_testing/worlds.hpp"

namespace vibe::shell_scene_test {
namespace {

using test::icosphere;
using test::plainOrgan;
using test::World;

constexpr double kRadius = 0.05, kWall = 2e-3;

Scene livelyScene() {
  Scene scene;
  scene.tissue.model = "shell";
  scene.gravity = GravityScene{};
  scene.foundation = FoundationScene{};
  scene.foundation->carries_weight = false;
  scene.gas = GasScene{};
  scene.gas->insufflator_on = true;
  return scene;
}

// @param cuts  of the icosphere; a wall of 4 is evaluated in pieces
World livelyWorld(int threads = 1, int cuts = 3) {
  return World(livelyScene(), plainOrgan(icosphere(kRadius, cuts), kWall), "", threads);
}

TEST(ShellScene, SameBitsOnEveryRunAndThreadCount) {
  World a = livelyWorld(), b = livelyWorld(), c = livelyWorld(3);
  for (World* world : {&a, &b, &c}) world->run(0.7);
  EXPECT_GT(a.maxShift(), 1e-3);
  EXPECT_EQ(hash(a.state), hash(b.state));
  EXPECT_EQ(hash(a.state), hash(c.state));
}

TEST(ShellScene, SameBitsOfALargeWallWithAnyThreadCount) {
  World a = livelyWorld(1, 4), b = livelyWorld(2, 4), c = livelyWorld(5, 4);
  for (World* world : {&a, &b, &c}) world->run(0.3);
  EXPECT_GT(a.maxShift(), 1e-3);
  EXPECT_EQ(hash(a.state), hash(b.state));
  EXPECT_EQ(hash(a.state), hash(c.state));
}

TEST(ShellScene, SameBitsOfWallsThatMeetWithAnyThreadCount) {
  Scene scene = livelyScene();
  scene.tissue.self_contact = true;
  const auto squashed = [&](int threads) {
    World world(scene, plainOrgan(icosphere(kRadius, 3), kWall), "", threads);
    for (double& z : world.state.z) z *= 0.9 * kWall / (2 * kRadius);
    world.step();
    EXPECT_GT(world.state.energy.contact_energy, 0);
    world.run(0.05);
    return hash(world.state);
  };
  const auto one = squashed(1);
  EXPECT_EQ(squashed(2), one);
  EXPECT_EQ(squashed(5), one);
}

TEST(ShellScene, ASnapshotAtAnyStepContinuesToTheBit) {
  for (int at : {1, 9, 10, 11, 25}) {
    World world = livelyWorld();
    for (int i = 0; i < at; ++i) world.step();
    const std::string file = ::testing::TempDir() + "vibe_shell_scene_test.bin";
    saveSnapshot(*world.model, world.state, file);
    State loaded = loadSnapshot(*world.model, file);
    std::remove(file.c_str());
    Workspace other(*world.model);
    std::vector<Event> events;
    for (int i = 0; i < 30; ++i) {
      world.step();
      step(*world.model, loaded, {}, other, events);
      ASSERT_EQ(hash(loaded), hash(world.state)) << "saved at " << at << ", step " << i;
    }
  }
}

// A factor is named at one step and takes over at a later one: what of it is under way travels with the state.
TEST(ShellScene, ASnapshotBetweenNamingAndTakeoverContinuesToTheBit) {
  World world = livelyWorld();
  for (int i = 0; i < 60 && world.state.solver.next.empty(); ++i) world.step();
  ASSERT_FALSE(world.state.solver.next.empty());
  const std::int64_t due = world.state.solver.due;
  ASSERT_GT(due, world.state.solver.steps + 3);
  std::vector<State> states;
  for (std::int64_t i = world.state.solver.steps; i <= due + 2; ++i) states.push_back(world.state), world.step();
  world.run(0.3);
  for (const State& state : states) {
    const std::string file = ::testing::TempDir() + "vibe_shell_scene_due_test.bin";
    saveSnapshot(*world.model, state, file);
    State loaded = loadSnapshot(*world.model, file);
    std::remove(file.c_str());
    ASSERT_EQ(hash(loaded), hash(state));
    Workspace other(*world.model);
    std::vector<Event> events;
    while (loaded.step < world.state.step) step(*world.model, loaded, {}, other, events);
    EXPECT_EQ(hash(loaded), hash(world.state)) << "saved at " << state.solver.steps << ", taken over at " << due;
  }
}

TEST(ShellScene, WhatTheSolverRemembersCounts) {
  Scene scene = livelyScene();
  scene.tissue.iterations = 1;  // what a step leaves out hangs on the usual length of its moves
  World world(scene, plainOrgan(icosphere(kRadius, 3), kWall));
  world.run(0.25);  // until the usual length is one
  for (int i = 0; i < 60 && world.state.solver.next.empty(); ++i) world.step();
  ASSERT_FALSE(world.state.solver.next.empty());
  const auto future = [&](State state) {
    Workspace other(*world.model);
    std::vector<Event> events;
    for (int i = 0; i < 20; ++i) step(*world.model, state, {}, other, events);
    return state.x;
  };
  const std::vector<double> positions = future(world.state);
  State later = world.state, shorter = world.state;
  later.solver.due += 1;
  shorter.solver.usual_length = 0;
  EXPECT_TRUE(future(later) != positions);
  EXPECT_TRUE(future(shorter) != positions);
  const auto changed = [&](auto change) {
    State state = world.state;
    change(state.solver);
    return hash(state) != hash(world.state);
  };
  EXPECT_TRUE(changed([](StepperMemory& memory) { ++memory.due; }));
  EXPECT_TRUE(changed([](StepperMemory& memory) { memory.usual_length *= 1.001; }));
  EXPECT_TRUE(changed([](StepperMemory& memory) { ++memory.steps; })) << "looks now and then whether it is lost";
  EXPECT_TRUE(changed([](StepperMemory& memory) { memory.elastic_energy *= 1.001; }));
  EXPECT_TRUE(changed([](StepperMemory& memory) { memory.next.clear(); }));
  EXPECT_FALSE(changed([](StepperMemory&) {}));
}

// Walls that catch in each other for good are a case of vibe_contact, wind; here, what is counted of it.
TEST(ShellScene, WallsThatWereJammedForASecondAreLedBackToRest) {
  World freed = livelyWorld(), jammed = livelyWorld();
  freed.state.solver.jammed_steps = 30;
  jammed.state.solver.jammed_steps = 60;
  freed.run(0.6);
  EXPECT_EQ(freed.state.solver.jammed_steps, 0) << "what is free is counted back";
  EXPECT_EQ(freed.count(Event::Kind::Recovery), 0);
  jammed.run(0.1);
  EXPECT_GT(jammed.state.solver.recovery_steps, 0);
  EXPECT_EQ(jammed.count(Event::Kind::Recovery), 1);
  jammed.run(1);
  EXPECT_EQ(jammed.state.solver.recovery_steps, 0);
  EXPECT_EQ(jammed.count(Event::Kind::Recovery), 1);
}

TEST(ShellScene, ASleepingStateWakesUnderOtherLoads) {
  Scene quiet = livelyScene();
  quiet.gravity.reset();
  quiet.gas.reset();
  const Organ organ = plainOrgan(icosphere(kRadius, 3), kWall);
  World asleep(quiet, organ);
  asleep.run(1);
  ASSERT_GT(asleep.state.solver.rest_steps, 0);
  const std::int64_t before = asleep.state.solver.steps;
  asleep.run(1);
  EXPECT_LT(asleep.state.solver.steps - before, 6) << "it does not sleep";
  EXPECT_LT(asleep.maxShift(), 1e-9);

  Scene heavy = quiet;
  heavy.gravity = GravityScene{};
  World awake(heavy, organ), placed(heavy, organ);
  placed.state = asleep.state;
  for (World* world : {&awake, &placed}) world->run(4);
  EXPECT_GT(placed.maxShift(), 1e-3);
  EXPECT_NEAR(placed.maxShift(), awake.maxShift(), 1e-5);
}

TEST(ShellScene, BalloonObeysTheMembraneFormula) {
  Scene scene;
  scene.tissue.model = "shell";
  scene.tissue.law = "neo_hookean";
  scene.gas = GasScene{};
  scene.gas->insufflator_on = true;
  scene.gas->flow_limit = 1e-2;
  scene.gas->regulated_pressure = 0.01 * 2 * scene.tissue.young_modulus * kWall / kRadius;
  World world(scene, plainOrgan(icosphere(kRadius, 3), kWall));
  world.run(3);
  EXPECT_NEAR(world.state.pressure, scene.gas->regulated_pressure, 1e-3 * scene.gas->regulated_pressure);
  const double strain = std::cbrt(world.state.volume / world.model->rest_volume) - 1;
  const double paper = 2 * scene.tissue.young_modulus * strain * kWall / ((1 - scene.tissue.poisson_ratio) * kRadius);
  EXPECT_NEAR(paper / world.state.pressure, 1, 0.04);
  EXPECT_NEAR(lumenVolume(world.model->organ.surface, world.state.x, world.state.y, world.state.z), world.state.volume,
              1e-9 * world.state.volume);
}

TEST(ShellScene, TheBedCarriesTheWeight) {
  Scene scene = livelyScene();
  scene.gas.reset();
  World world(scene, plainOrgan(icosphere(kRadius, 3), kWall));
  world.run(4);
  Eigen::Vector3d residual = Eigen::Vector3d::Zero();
  double weight = 0;
  for (int i = 0; i < world.model->particle_count; ++i) {
    const Eigen::Vector3d moved = world.position(i) - world.model->organ.surface.vertices[i];
    residual +=
        world.model->mass[i] * scene.gravity->acceleration - scene.foundation->stiffness * world.model->area[i] * moved;
    weight += world.model->mass[i] * scene.gravity->acceleration.norm();
  }
  EXPECT_LT(residual.norm(), 2e-3 * weight);
}

}  // namespace
}  // namespace vibe::shell_scene_test
