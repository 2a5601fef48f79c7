// The shell and the implicit solver in a whole scene: gas, weight, determinism, snapshots.
#include <gtest/gtest.h>

#include <cstdio>

#include "vibe_sim/snapshot.hpp"
#include "vibe_sim/solver/gas.hpp"
#include "vibe_sim/solver/lumen.hpp"
#include "worlds.hpp"

namespace vibe {
namespace {

using test::icosphere;
using test::plainOrgan;
using test::World;

constexpr double kRadius = 0.05, kWall = 2e-3;

Scene livelyScene() {
  Scene scene;
  scene.tissue.model = "shell";
  scene.gravity = GravityScene{};
  scene.bed = BedScene{};
  scene.bed->carries_weight = false;
  scene.gas = GasScene{};
  scene.gas->insufflator_on = true;
  return scene;
}

World livelyWorld(int threads = 1) {
  return World(livelyScene(), plainOrgan(icosphere(kRadius, 3), kWall), "", threads);
}

TEST(ShellScene, SameBitsOnEveryRunAndThreadCount) {
  World a = livelyWorld(), b = livelyWorld(), c = livelyWorld(3);
  for (World* world : {&a, &b, &c}) world->run(0.7);
  EXPECT_GT(a.greatestShift(), 1e-3);
  EXPECT_EQ(hash(a.state), hash(b.state));
  EXPECT_EQ(hash(a.state), hash(c.state));
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
  Eigen::Vector3d lack = Eigen::Vector3d::Zero();
  double weight = 0;
  for (int i = 0; i < world.model->particle_count; ++i) {
    const Eigen::Vector3d moved = world.position(i) - world.model->organ.surface.vertices[i];
    lack += world.model->mass[i] * scene.gravity->acceleration - scene.bed->stiffness * world.model->area[i] * moved;
    weight += world.model->mass[i] * scene.gravity->acceleration.norm();
  }
  EXPECT_LT(lack.norm(), 2e-3 * weight);
}

}  // namespace
}  // namespace vibe
