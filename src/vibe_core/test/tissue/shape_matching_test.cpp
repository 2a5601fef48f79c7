#include "tissue/shape_matching.hpp"

#include <gtest/gtest.h>

#include <Eigen/SVD>
#include <random>

#include "tissue/shape_matching_kernel.hpp"
#include "vibe_core/arithmetic/machine.hpp"
#include "vibe_core/model/accounting.hpp"
#include "vibe_testing/worlds.hpp"

namespace vibe::shape_matching_test {
namespace {

using test::bareScene;
using test::icosphere;
using test::plainOrgan;
using test::World;

constexpr double kRadius = 0.05;
constexpr double kThickness = 2e-3;

World smallWorld(int level = 2, int substeps = 40) {
  Scene scene = bareScene();
  scene.tissue.substeps = substeps;
  return World(scene, plainOrgan(icosphere(kRadius, level), kThickness));
}

const ShapeMatching& tissueOf(const World& world) {
  return dynamic_cast<const ShapeMatching&>(*world.model->tissue);
}

void shake(State& state, double amplitude, unsigned seed) {
  std::mt19937 generator(seed);
  std::uniform_real_distribution<double> uniform(-amplitude, amplitude);
  for (auto* v : {&state.x, &state.y, &state.z})
    for (double& value : *v) value += uniform(generator);
}

void transform(State& state, const Eigen::Isometry3d& motion) {
  for (std::size_t i = 0; i < state.x.size(); ++i) {
    const Eigen::Vector3d p = motion * Eigen::Vector3d(state.x[i], state.y[i], state.z[i]);
    state.x[i] = p.x(), state.y[i] = p.y(), state.z[i] = p.z();
    const Eigen::Quaterniond q =
        Eigen::Quaterniond(motion.linear()) * Eigen::Quaterniond(state.qw[i], state.qx[i], state.qy[i], state.qz[i]);
    state.qw[i] = q.w(), state.qx[i] = q.x(), state.qy[i] = q.y(), state.qz[i] = q.z();
  }
}

Eigen::Isometry3d someMotion() {
  Eigen::Isometry3d motion = Eigen::Isometry3d::Identity();
  motion.linear() = Eigen::AngleAxisd(1.1, Eigen::Vector3d(1, -2, 0.5).normalized()).toRotationMatrix();
  motion.translation() = Eigen::Vector3d(0.03, -0.2, 0.1);
  return motion;
}

// Sweeps without time until the orientations fit the positions.
SweepBuffers converged(const ClusterSet& clusters, const State& state) {
  SweepBuffers buffers = makeSweepBuffers(clusters);
  loadOrientations(clusters, state, buffers);
  const ClusterSweep sweep = bindSweep(clusters, state, buffers);
  for (int i = 0; i < 60; ++i) chooseClusterSweep()(sweep, 0, clusters.group_count);
  return buffers;
}

void settleOrientations(const World& world, State& state) {
  storeOrientations(tissueOf(world).clusters(), converged(tissueOf(world).clusters(), state), state);
}

int slotOf(const ClusterSet& c, int lane, int row) {
  return (c.row_offset[lane / ClusterSet::kLanes] + row) * ClusterSet::kLanes + lane % ClusterSet::kLanes;
}

TEST(ShapeMatching, OneFullProjectionOfOneClusterSatisfiesIt) {
  World world = smallWorld();
  ClusterSet clusters = tissueOf(world).clusters();
  std::fill(clusters.gain.begin(), clusters.gain.end(), 1.0);
  shake(world.state, 2e-3, 1);
  const int lane = clusters.lane_of_particle[17];
  const int rows = clusters.row_offset[lane / ClusterSet::kLanes + 1] - clusters.row_offset[lane / ClusterSet::kLanes];

  const auto residual = [&](const SweepBuffers& b) {
    double sum = 0;
    for (int row = 0; row < rows; ++row) {
      const int slot = slotOf(clusters, lane, row);
      if (clusters.weight[slot] == 0) continue;
      sum += std::hypot(b.dx[slot], b.dy[slot], b.dz[slot]);
    }
    return sum;
  };
  const SweepBuffers before = converged(clusters, world.state);
  EXPECT_GT(residual(before), 1e-3);  // else the test shows nothing
  for (int row = 0; row < rows; ++row) {
    const int slot = slotOf(clusters, lane, row);
    if (clusters.weight[slot] == 0) continue;
    const int i = clusters.particle[slot];
    world.state.x[i] += before.dx[slot];
    world.state.y[i] += before.dy[slot];
    world.state.z[i] += before.dz[slot];
  }
  EXPECT_LT(residual(converged(clusters, world.state)), 1e-12);
}

TEST(ShapeMatching, BothInstructionPathsGiveTheSameBits) {
  if (widestInstructionSet() == InstructionSet::Sse2) GTEST_SKIP() << "this machine has one path only";
  World world = smallWorld(3);
  shake(world.state, 1e-3, 2);
  const ClusterSet& clusters = tissueOf(world).clusters();
  SweepBuffers narrow = makeSweepBuffers(clusters), wide = narrow;
  ClusterSweep sweep = bindSweep(clusters, world.state, narrow);
  sweep.substep = 1e-3;
  for (int i = 0; i < 5; ++i) sweepClustersSse2(sweep, 0, clusters.group_count);
  sweep = bindSweep(clusters, world.state, wide);
  sweep.substep = 1e-3;
  for (int i = 0; i < 5; ++i) sweepClustersAvx2(sweep, 0, clusters.group_count);
  EXPECT_EQ(narrow.dx, wide.dx);
  EXPECT_EQ(narrow.qw, wide.qw);
  EXPECT_EQ(narrow.wz, wide.wz);
  EXPECT_EQ(narrow.area_y, wide.area_y);
  EXPECT_EQ(narrow.spread, wide.spread);
}

TEST(ShapeMatching, EnergyDoesNotSeeRigidMotion) {
  World world = smallWorld();
  shake(world.state, 1e-3, 3);
  settleOrientations(world, world.state);
  State moved = world.state;
  transform(moved, someMotion());
  const double energy = world.model->tissue->energy(world.state);
  ASSERT_GT(energy, 0);
  EXPECT_NEAR(world.model->tissue->energy(moved), energy, 1e-9 * energy);
  // control: a motion that is not rigid is seen
  for (double& x : moved.x) x *= 1.01;
  EXPECT_GT(std::abs(world.model->tissue->energy(moved) - energy), 1e-4 * energy);
}

TEST(ShapeMatching, ForcesTurnWithTheBody) {
  World world = smallWorld();
  shake(world.state, 1e-3, 4);
  settleOrientations(world, world.state);
  State moved = world.state;
  const Eigen::Isometry3d motion = someMotion();
  transform(moved, motion);
  const std::size_t n = world.state.x.size();
  std::vector<double> f[3], g[3];
  for (int k = 0; k < 3; ++k) f[k].assign(n, 0), g[k].assign(n, 0);
  world.model->tissue->addForces(world.state, f[0].data(), f[1].data(), f[2].data());
  world.model->tissue->addForces(moved, g[0].data(), g[1].data(), g[2].data());
  double max = 0, difference = 0;
  for (std::size_t i = 0; i < n; ++i) {
    const Eigen::Vector3d a = motion.linear() * Eigen::Vector3d(f[0][i], f[1][i], f[2][i]);
    const Eigen::Vector3d b(g[0][i], g[1][i], g[2][i]);
    max = std::max(max, a.norm());
    difference = std::max(difference, (a - b).norm());
  }
  ASSERT_GT(max, 1e-3);
  EXPECT_LT(difference, 1e-8 * max);
}

// The own orientation of the particles is part of the state, so the energy by position alone is not quite a potential;
// its weight (t^2/12 against the ring's spread) bounds the difference.
TEST(ShapeMatching, ForceIsTheSlopeOfTheEnergy) {
  World world = smallWorld();
  shake(world.state, 5e-4, 5);
  settleOrientations(world, world.state);
  const std::size_t n = world.state.x.size();
  std::vector<double> fx(n, 0), fy(n, 0), fz(n, 0);
  world.model->tissue->addForces(world.state, fx.data(), fy.data(), fz.data());
  const double step = 1e-7;
  double square = 0, error = 0;
  for (int i = 0; i < 20; ++i) {
    const auto energyAt = [&](double shift) {
      State s = world.state;
      s.x[i] += shift;
      settleOrientations(world, s);
      return world.model->tissue->energy(s);
    };
    const double slope = (energyAt(step) - energyAt(-step)) / (2 * step);
    square += slope * slope;
    error += (slope + fx[i]) * (slope + fx[i]);
  }
  EXPECT_LT(std::sqrt(error / square), 0.01);
}

TEST(ShapeMatching, UniformStretchCostsTheEnergyOfAMembrane) {
  for (int level : {2, 3, 4}) {
    World world = smallWorld(level, 200);
    ASSERT_EQ(world.model->tissue->stiffnessRatio(), 1.0);
    const double strain = 0.03;
    for (auto* v : {&world.state.x, &world.state.y, &world.state.z})
      for (double& value : *v) value *= 1 + strain;
    const TissueScene& t = world.model->scene.tissue;
    const double modulus = t.young_modulus * kThickness / (1 - t.poisson_ratio);
    const double membrane = modulus * surfaceArea(world.model->organ.surface) * strain * strain;
    EXPECT_NEAR(world.model->tissue->energy(world.state) / membrane, 1, 1e-9) << "level " << level;
    std::vector<float> measured(world.state.x.size());
    world.model->tissue->strain(world.state, measured.data());
    for (float s : measured) EXPECT_NEAR(s, strain, 1e-6);
  }
}

TEST(ShapeMatching, TooLongSubstepsAreReportedAsSoftness) {
  EXPECT_EQ(smallWorld(3, 60).model->tissue->stiffnessRatio(), 1.0);
  const double ratio = smallWorld(3, 10).model->tissue->stiffnessRatio();
  EXPECT_LT(ratio, 0.3);
  EXPECT_GT(ratio, 0.01);
}

TEST(ShapeMatching, FewestSubstepsCarryTheStiffnessAndOneLessDoesNot) {
  const int substeps = smallWorld(3, 0).model->substeps;
  ASSERT_GT(substeps, 2);
  EXPECT_EQ(smallWorld(3, substeps).model->tissue->stiffnessRatio(), 1.0);
  EXPECT_LT(smallWorld(3, substeps - 1).model->tissue->stiffnessRatio(), 1.0);
}

TEST(ShapeMatching, OrientationIsThePolarRotationOfTheMoments) {
  World world = smallWorld();
  shake(world.state, 1.5e-3, 6);
  transform(world.state, someMotion());
  for (auto* v : {&world.state.qx, &world.state.qy, &world.state.qz}) std::fill(v->begin(), v->end(), 0);
  std::fill(world.state.qw.begin(), world.state.qw.end(), 1.0);  // the kernel starts from the wrong orientation
  ClusterSet clusters = tissueOf(world).clusters();
  std::fill(clusters.orientation_weight.begin(), clusters.orientation_weight.end(), 0.0);
  const SweepBuffers b = converged(clusters, world.state);
  for (int i = 0; i < clusters.particle_count; i += 13) {
    const int lane = clusters.lane_of_particle[i];
    Eigen::Matrix3d a = Eigen::Matrix3d::Zero();
    for (int row = 0; row <= 6; ++row) {
      const int slot = slotOf(clusters, lane, row);
      if (row >= clusters.row_offset[lane / 8 + 1] - clusters.row_offset[lane / 8] || clusters.weight[slot] == 0)
        continue;
      const int m = clusters.particle[slot];
      a += clusters.weight[slot] * world.position(m) *
           Eigen::Vector3d(clusters.rest_x[slot], clusters.rest_y[slot], clusters.rest_z[slot]).transpose();
    }
    const Eigen::JacobiSVD<Eigen::Matrix3d> svd(a, Eigen::ComputeFullU | Eigen::ComputeFullV);
    Eigen::Matrix3d u = svd.matrixU();
    if ((u * svd.matrixV().transpose()).determinant() < 0) u.col(2) *= -1;
    const Eigen::Matrix3d expected = u * svd.matrixV().transpose();
    const Eigen::Quaterniond q(b.qw[lane], b.qx[lane], b.qy[lane], b.qz[lane]);
    EXPECT_LT((q.toRotationMatrix() - expected).norm(), 1e-6) << "cluster " << i;
  }
}

TEST(ShapeMatching, RefusesAnOpenSurface) {
  Organ organ = plainOrgan(icosphere(kRadius, 1), kThickness);
  organ.surface.triangles.pop_back();
  EXPECT_THROW(World(bareScene(), organ), std::exception);
}

}  // namespace
}  // namespace vibe::shape_matching_test
