// What the time scheme does to vibrations: its damping ratio is that of its amplification matrix, and free motion
// without damping does not gain energy at any spectral radius that a scene may have.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>

#include "vibe_core/model/accounting.hpp"
#include "vibe_testing/worlds.hpp"

namespace vibe::numerical_damping_test {
namespace {

using test::icosphere;
using test::plainOrgan;
using test::World;

constexpr double kRadius = 0.05, kWall = 2.3e-3;

Scene undampedScene(double spectral_radius) {
  Scene scene;
  scene.tissue.model = "shell";
  scene.tissue.mass_damping = 0;
  scene.tissue.stiffness_damping = 0;
  scene.tissue.spectral_radius = spectral_radius;
  scene.foundation = FoundationScene{};
  return scene;
}

/// Position, velocity times step and acceleration times its square after a step of generalised-alpha from those before,
/// for a vibration of `phase` = angular frequency times step (Chung, Hulbert 1993, equations 7 to 12).
Eigen::Matrix3d amplification(double r, double phase) {
  const double am = (2 * r - 1) / (r + 1), af = r / (r + 1), gamma = 0.5 - am + af;
  const double beta = 0.25 * (1 - am + af) * (1 - am + af), square = phase * phase;
  const Eigen::RowVector3d free_x(1, 1, 0.5 - beta), free_v(0, 1, 1 - gamma), unit_x(1, 0, 0), unit_a(0, 0, 1);
  const Eigen::RowVector3d end =
      -(am * unit_a + square * ((1 - af) * free_x + af * unit_x)) / ((1 - am) + square * (1 - af) * beta);
  Eigen::Matrix3d matrix;
  matrix << free_x + beta * end, free_v + gamma * end, end;
  return matrix;
}

double dampingRatio(double r, double phase) {
  const Eigen::Vector3cd roots = amplification(r, phase).eigenvalues();
  std::complex<double> root = roots[0];
  for (int i = 1; i < 3; ++i)
    if (std::abs(roots[i].imag()) > std::abs(root.imag())) root = roots[i];
  return -std::log(std::abs(root)) / std::abs(std::arg(root));
}

// A ball swings on its foundation as a whole: all particles have the same frequency.
TEST(NumericalDamping, IsThatOfTheAmplificationMatrix) {
  for (const double radius : {0.0, 0.2, 0.5}) {
    Scene scene = undampedScene(radius);
    const double phase = 2 * M_PI * 10 * scene.step_period;  // 10 Hz
    scene.foundation->stiffness = std::pow(phase / scene.step_period, 2) * scene.tissue.density * kWall;
    World world(scene, plainOrgan(icosphere(kRadius, 2), kWall));
    for (double& x : world.state.x) x += 1e-3;
    Eigen::Vector3d expected(1e-3, 0, 0);
    for (int i = 0; i < 30; ++i) {
      world.step();
      expected = (amplification(radius, phase) * expected).eval();
      const double moved = world.state.x[7] - world.model->organ.surface.vertices[7].x();
      ASSERT_NEAR(moved, expected[0], 2e-6) << radius << ", step " << i;
    }
  }
  // as in docs/accuracy.md
  EXPECT_NEAR(dampingRatio(0.2, 2 * M_PI * 15 / 60), 0.116, 1e-3);
  EXPECT_NEAR(dampingRatio(0.5, 2 * M_PI * 10 / 60), 0.0132, 1e-4);
}

double energyOf(const World& world) {
  return energies(*world.model, world.state).total();
}

/// Largest energy of a ball that is let go from a dent of 2 cm, over the energy at the start.
double growth(double spectral_radius) {
  World world(undampedScene(spectral_radius), plainOrgan(icosphere(kRadius, 3), kWall));
  for (std::size_t i = 0; i < world.state.z.size(); ++i) world.state.z[i] = std::min(world.state.z[i], kRadius - 0.02);
  const double start = energyOf(world);
  double max = 0;
  for (int i = 0; i < 300; ++i) {
    world.step();
    max = std::max(max, energyOf(world));
  }
  return max / start;
}

TEST(NumericalDamping, FreeMotionNeverGainsEnergy) {
  for (const double radius : {0.0, 0.2, 0.5}) EXPECT_LE(growth(radius), 1 + 1e-3) << radius;
  EXPECT_GT(growth(1), 1.1) << "this is why a scene may not have it";
}

}  // namespace
}  // namespace vibe::numerical_damping_test
