// Physics with an answer on paper: fall, momentum, rest, a weight on its foundation.
#include <gtest/gtest.h>

#include "vibe_core/model/accounting.hpp"
#include "vibe_testing/worlds.hpp"

namespace vibe::free_body_test {
namespace {

using test::bareScene;
using test::icosphere;
using test::plainOrgan;
using test::World;

constexpr double kThickness = 2e-3;

Organ ball(int level = 2) {
  return plainOrgan(icosphere(0.05, level), kThickness);
}

Eigen::Vector3d meanShift(const World& world) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (int i = 0; i < world.model->particle_count; ++i)
    sum += world.position(i) - world.model->organ.surface.vertices[i];
  return sum / world.model->particle_count;
}

TEST(FreeBody, FallsAsGalileoSays) {
  Scene scene = bareScene();
  scene.gravity = GravityScene{};
  World world(scene, ball());
  world.run(1.0);
  const double h = scene.step_period / scene.tissue.substeps;
  const Eigen::Vector3d g = scene.gravity->acceleration;
  // symplectic Euler adds exactly half a sub-step
  const Eigen::Vector3d expected = 0.5 * g * (1 + h);
  EXPECT_LT((meanShift(world) - expected).norm(), 1e-9);
  EXPECT_NEAR(world.state.vx[0], g.x(), 1e-9);
  // it falls without changing its shape
  EXPECT_LT(world.model->tissue->energy(world.state), 1e-15);
}

TEST(FreeBody, WithDampingReachesTheTerminalSpeed) {
  Scene scene = bareScene();
  scene.gravity = GravityScene{};
  scene.tissue.mass_damping = 50;
  World world(scene, ball());
  world.run(1.0);
  const double h = scene.step_period / scene.tissue.substeps;
  // g / mass_damping in the limit of short sub-steps; the scheme's own fixed point to the last digits
  EXPECT_NEAR(world.state.vx[3], -9.81 / 50, 0.5 * 50 * h * 9.81 / 50 * 1.02);
  EXPECT_NEAR(world.state.vx[3], -9.81 * h / (1 - std::exp(-50 * h)), 1e-9);
}

TEST(FreeBody, KeepsItsMomentum) {
  World world(bareScene(), ball(3));
  for (int i = 0; i < world.model->particle_count; ++i) {
    const Eigen::Vector3d p = world.position(i);
    const Eigen::Vector3d v = Eigen::Vector3d(1, 2, 3).cross(p) + Eigen::Vector3d(2 * p.y(), 0, 0.05);
    world.state.vx[i] = v.x(), world.state.vy[i] = v.y(), world.state.vz[i] = v.z();
  }
  const Eigen::Vector3d linear = linearMomentum(*world.model, world.state);
  const Eigen::Vector3d angular = angularMomentum(*world.model, world.state);
  const double energy = energies(*world.model, world.state).total();
  world.run(1.0);
  EXPECT_LT((linearMomentum(*world.model, world.state) - linear).norm(), 1e-9 * linear.norm());
  EXPECT_LT((angularMomentum(*world.model, world.state) - angular).norm(), 3e-3 * angular.norm());
  EXPECT_NEAR(energies(*world.model, world.state).total(), energy, 0.02 * energy);
  EXPECT_GT(energies(*world.model, world.state).elastic, 1e-3 * energy);  // it did deform
}

TEST(FreeBody, StaysAtRestForTenSeconds) {
  World world(bareScene(), ball(3));
  world.run(10.0);
  EXPECT_LT(world.maxShift(), 1e-9);
}

TEST(FreeBody, RestIsRestInAnyOrientation) {
  Organ organ = ball(2);
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, 1, 0).normalized()).toRotationMatrix();
  for (auto& v : organ.surface.vertices) v = turn * v + Eigen::Vector3d(0.3, -0.2, 0.5);
  World world(bareScene(), organ);
  world.run(10.0);
  EXPECT_LT(world.maxShift(), 1e-9);
}

TEST(FreeBody, SameMotionSeenFromATurnedFrame) {
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(1.3, Eigen::Vector3d(0.2, 1, -0.4).normalized()).toRotationMatrix();
  Organ turned = ball(2);
  for (auto& v : turned.surface.vertices) v = turn * v;
  World a(bareScene(), ball(2)), b(bareScene(), turned);
  for (int i = 0; i < a.model->particle_count; ++i) {
    const Eigen::Vector3d v(0.5 * std::sin(40 * a.position(i).x()), 0.3 * a.position(i).z() / 0.05, 0);
    const Eigen::Vector3d w = turn * v;
    a.state.vx[i] = v.x(), a.state.vy[i] = v.y(), a.state.vz[i] = v.z();
    b.state.vx[i] = w.x(), b.state.vy[i] = w.y(), b.state.vz[i] = w.z();
  }
  a.run(0.5);
  b.run(0.5);
  double difference = 0;
  for (int i = 0; i < a.model->particle_count; ++i)
    difference = std::max(difference, (turn * a.position(i) - b.position(i)).norm());
  EXPECT_GT(a.maxShift(), 1e-3);
  EXPECT_LT(difference, 1e-9);
}

TEST(Foundation, CarriesAHangingWeight) {
  Scene scene = bareScene();
  scene.gravity = GravityScene{};
  scene.foundation = FoundationScene{};
  scene.foundation->carries_weight = false;
  scene.tissue.mass_damping = 30;
  World world(scene, ball());
  world.run(4.0);
  // every particle hangs on its own piece of foundation: m g = k A s, whatever the wall
  const double sag = scene.tissue.density * kThickness * 9.81 / scene.foundation->stiffness;
  for (int i = 0; i < world.model->particle_count; ++i) {
    const Eigen::Vector3d shift = world.position(i) - world.model->organ.surface.vertices[i];
    EXPECT_NEAR(shift.x(), -sag, 1e-3 * sag);
    EXPECT_NEAR(shift.y(), 0, 1e-3 * sag);
  }
}

TEST(Foundation, ThatCarriesTheWeightLeavesTheShape) {
  Scene scene = bareScene();
  scene.gravity = GravityScene{};
  scene.foundation = FoundationScene{};
  World world(scene, ball());
  world.run(10.0);
  EXPECT_LT(world.maxShift(), 1e-9);
}

TEST(Attachment, HeldParticlesDoNotMove) {
  Scene scene = bareScene();
  scene.gravity = GravityScene{};
  scene.attach_oesophagus = true;
  Organ organ = ball();
  for (std::size_t i = 0; i < organ.end.size(); ++i)
    if (organ.surface.vertices[i].z() > 0.045) organ.end[i] = End::Oesophagus;
  World world(scene, organ);
  world.run(0.3);
  int held = 0;
  for (int i = 0; i < world.model->particle_count; ++i) {
    if (organ.end[i] == End::None) continue;
    ++held;
    EXPECT_EQ(world.position(i), organ.surface.vertices[i]);
  }
  EXPECT_GT(held, 3);
  EXPECT_GT(world.maxShift(), 1e-4);  // the rest swings
}

}  // namespace
}  // namespace vibe::free_body_test
