// The hand that pulls the tissue from outside: force, limits, release, account, snapshots.
#include "vibe_core/constraints/pull_patch.hpp"
#include "vibe_core/state/state.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <limits>

#include "vibe_core/model/accounting.hpp"
#include "vibe_core/simulation/snapshot.hpp"
#include "vibe_testing/worlds.hpp"

namespace vibe::pull_spring_test {
namespace {

using test::icosphere;
using test::plainOrgan;
using test::World;

constexpr double kRadius = 0.03, kWall = 2e-3;
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

Scene foundationScene(const std::string& model) {
  Scene scene;
  scene.tissue.model = model;
  scene.tissue.mass_damping = 5;
  scene.foundation = FoundationScene{};
  return scene;
}

World foundationWorld(const std::string& model) {
  return World(foundationScene(model), plainOrgan(icosphere(kRadius, 3), kWall));
}

// Outwards from the place at rest of the held patch.
StepInput pull(const World& world, int particle, double way) {
  State state = world.state;
  StepInput input;
  input.pull_particle = particle;
  movePullSpring(*world.model, input, state);
  const Eigen::Vector3d place = heldPosition(state);
  input.pull_target = place + way * place.normalized();
  return input;
}

Eigen::Vector3d foundationForce(const World& world) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (int i = 0; i < world.model->particle_count; ++i)
    sum -= world.model->scene.foundation->stiffness * world.model->area[i] *
           (world.position(i) - world.model->organ.surface.vertices[i]);
  return sum;
}

class PullSpringTest : public testing::TestWithParam<const char*> {};

TEST_P(PullSpringTest, atRestTheSpringPullsWithTheForceThatTheBedBears) {
  World world = foundationWorld(GetParam());
  const StepInput input = pull(world, 17, 8e-3);
  world.run(3, input);
  const PullSpring& pull = world.state.pull;
  EXPECT_GT(pull.node.size(), 5u);
  EXPECT_EQ(pull.target, input.pull_target);
  EXPECT_GT(pull.force.norm(), 0.2);
  EXPECT_LT((pull.force - kPullStiffness * (pull.target - heldPosition(world.state))).norm(), 1e-3 * pull.force.norm());
  EXPECT_LT((pull.force + foundationForce(world)).norm(), 0.02 * pull.force.norm());
}

TEST_P(PullSpringTest, whatIsLetGoComesBack) {
  World world = foundationWorld(GetParam());
  world.run(1, pull(world, 17, 8e-3));
  EXPECT_GT(world.maxShift(), 1e-3);
  world.step();
  EXPECT_FALSE(world.state.pull.holds());
  EXPECT_EQ(world.state.pull.particle, -1);
  EXPECT_TRUE(world.state.pull.force.isZero());
  world.run(5);
  EXPECT_LT(world.maxShift(), 1e-4);
}

TEST_P(PullSpringTest, targetsFarAwayPullNoHarderThanAHandMayAndTearNothing) {
  World world = foundationWorld(GetParam());
  const StepInput input = pull(world, 17, 10);
  double max = 0;
  for (int i = 0; i < 240; ++i) {
    world.step(input);
    max = std::max(max, world.state.pull.force.norm());
  }
  EXPECT_LT(max, 1.02 * kPullForce);
  EXPECT_NEAR(world.state.pull.force.norm(), kPullForce, 0.02 * kPullForce);
  EXPECT_EQ(world.count(Event::Kind::Recovery), 0);
}

TEST_P(PullSpringTest, theTargetMovesNoFasterThanAHandMay) {
  World world = foundationWorld(GetParam());
  const StepInput input = pull(world, 17, 0.012);
  const double max = kPullSpeed * world.model->scene.step_period;
  world.step(input);
  EXPECT_NEAR((world.state.pull.target - input.pull_target).norm(), 0.012 - max, 1e-12);
  Eigen::Vector3d last = world.state.pull.target;
  for (int i = 0; i < 30; ++i, last = world.state.pull.target) {
    world.step(input);
    EXPECT_LE((world.state.pull.target - last).norm(), max * (1 + 1e-9));
  }
  EXPECT_EQ(last, input.pull_target);
}

TEST_P(PullSpringTest, whatCannotBePulledChangesNothing) {
  World with = foundationWorld(GetParam()), without = foundationWorld(GetParam());
  StepInput input = pull(with, 17, 8e-3);
  for (int particle : {-7, with.model->particle_count, 1 << 30}) {
    input.pull_particle = particle;
    with.run(0.1, input);
    without.run(0.1);
    EXPECT_EQ(hash(with.state), hash(without.state)) << particle;
    EXPECT_NE(pullRejection(*with.model, particle), "");
  }
  input.pull_particle = 17;
  input.pull_target.y() = kNan;
  with.run(0.1, input), without.run(0.1);
  EXPECT_EQ(hash(with.state), hash(without.state));
  input.pull_target.y() = 0;
  with.run(0.1, input), without.run(0.1);
  EXPECT_NE(hash(with.state), hash(without.state));
}

TEST_P(PullSpringTest, equalInputsGiveEqualBitsAndASnapshotGoesOnWithTheHand) {
  World a = foundationWorld(GetParam()), b = foundationWorld(GetParam()), c = foundationWorld(GetParam());
  const StepInput input = pull(a, 17, 8e-3);
  StepInput other = input;
  other.pull_target.x() += 1e-6;
  a.run(0.3, input), b.run(0.3, input), c.run(0.3, other);
  EXPECT_EQ(hash(a.state), hash(b.state));
  EXPECT_NE(hash(a.state), hash(c.state));
  const std::string file = testing::TempDir() + "vibe_tissue_hand_test.bin";
  saveSnapshot(*a.model, a.state, file);
  b.state = loadSnapshot(*b.model, file);
  std::remove(file.c_str());
  EXPECT_EQ(b.state.pull.weight, a.state.pull.weight);
  EXPECT_EQ(b.state.energy.pull_work, a.state.energy.pull_work);
  a.run(0.3, input), b.run(0.3, input);
  EXPECT_EQ(hash(a.state), hash(b.state));
}

TEST_P(PullSpringTest, theHashSeesTheHand) {
  World world = foundationWorld(GetParam());
  world.run(0.1, pull(world, 17, 8e-3));
  State changed = world.state;
  changed.pull.target.x() += 1e-12;
  EXPECT_NE(hash(changed), hash(world.state));
  changed = world.state;
  changed.pull.node.back() += 1;
  EXPECT_NE(hash(changed), hash(world.state));
}

TEST_P(PullSpringTest, itsWorkIsInTheAccount) {
  Scene scene = foundationScene(GetParam());
  scene.tissue.mass_damping = 0;
  scene.tissue.stiffness_damping = 0;
  scene.tissue.spectral_radius = 0.5;
  scene.step_period = 1e-3;
  World world(scene, plainOrgan(icosphere(kRadius, 3), kWall));
  const double before = energyBalance(*world.model, world.state);
  world.run(0.06, pull(world, 17, 8e-3));
  const double work = world.state.energy.pull_work;
  EXPECT_GT(work, 1e-3);
  EXPECT_NEAR(energyBalance(*world.model, world.state), before, 0.03 * work);
}

TEST_P(PullSpringTest, anotherParticleIsAnotherHold) {
  World world = foundationWorld(GetParam());
  world.run(0.5, pull(world, 17, 8e-3));
  StepInput input = pull(world, 40, 0);
  world.step(input);
  EXPECT_EQ(world.state.pull.particle, 40);
  EXPECT_LT(world.state.pull.force.norm(), 0.1) << "a new hold begins without force";
}

INSTANTIATE_TEST_SUITE_P(Tissues, PullSpringTest, testing::Values("shell", "shape_matching"));

TEST(PullSpring, holdsAPatchOfThisWallOnly) {
  SurfaceMesh flat = icosphere(kRadius, 3);
  int top = 0;
  for (Eigen::Vector3d& v : flat.vertices) v.z() *= 0.04;  // the walls lie 4 mm apart
  for (int i = 0; i < static_cast<int>(flat.vertices.size()); ++i)
    if (flat.vertices[i].z() > flat.vertices[top].z()) top = i;
  World world(foundationScene("shape_matching"), plainOrgan(flat, kWall));
  world.step(pull(world, top, 1e-3));
  const PullSpring& pull = world.state.pull;
  double sum = 0;
  ASSERT_GT(pull.node.size(), 3u);
  for (std::size_t k = 0; k < pull.node.size(); ++k) {
    EXPECT_GT(flat.vertices[pull.node[k]].z(), 0);
    EXPECT_LT((flat.vertices[pull.node[k]] - flat.vertices[top]).norm(), kPullRadius);
    EXPECT_GT(pull.weight[k], 0);
    sum += pull.weight[k];
  }
  EXPECT_NEAR(sum, 1, 1e-12);
  EXPECT_EQ(std::count(pull.node.begin(), pull.node.end(), top), 1);
}

TEST(PullSpring, holdsNothingThatIsHeldInPlace) {
  Organ organ = plainOrgan(icosphere(kRadius, 3), kWall);
  for (std::size_t i = 0; i < organ.end.size(); ++i)
    if (organ.surface.vertices[i].z() > 0.6 * kRadius) organ.end[i] = End::Oesophagus;
  Scene scene = foundationScene("shape_matching");
  scene.attach_oesophagus = true;
  World world(scene, organ);
  const auto above = [&](double z) {
    for (int i = 0; i < world.model->particle_count; ++i)
      if (organ.surface.vertices[i].z() > z) return i;
    return -1;
  };
  const int inside = above(0.9 * kRadius), rim = above(0.59 * kRadius);
  EXPECT_NE(pullRejection(*world.model, inside).find("held in place"), std::string::npos);
  world.step(pull(world, inside, 1e-3));
  EXPECT_FALSE(world.state.pull.holds());
  world.step(pull(world, rim, 1e-3));
  for (int i : world.state.pull.node) EXPECT_GT(world.model->inverse_mass[i], 0);
}

TEST(PullSpring, wakesTissueThatSleeps) {
  World world = foundationWorld("shell");
  world.run(2);
  ASSERT_EQ(world.maxShift(), 0);
  world.run(0.2, pull(world, 17, 8e-3));
  EXPECT_GT(world.maxShift(), 1e-3);
}

}  // namespace
}  // namespace vibe::pull_spring_test
