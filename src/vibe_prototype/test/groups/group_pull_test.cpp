// Pulling by the prototype's index groups, with both models of the wall.
#include "groups/group_pull.hpp"
#include "groups/group_draw.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cstdio>

#include "solver/pulled_sheet.hpp"
#include "solver/sum_term.hpp"
#include "vibe_core/simulation/snapshot.hpp"

namespace vibe::prototype::group_pull_test {
namespace {

using test::PulledSheet;
using test::sheetParticle;
using test::sheetScene;

constexpr int kMiddle = test::kColumns / 2, kRow = test::kRows / 2;

class GroupPullOf : public ::testing::TestWithParam<const char*> {
 protected:
  Scene scene() const { return sheetScene(GetParam(), "groups"); }
};

INSTANTIATE_TEST_SUITE_P(Walls, GroupPullOf, ::testing::Values("shell", "shape_matching"));

TEST_P(GroupPullOf, TakesWhatLiesBetweenTheBites) {
  const PulledSheet sheet(scene(), 4);
  std::vector<int> expected;
  for (int c = kMiddle - 4; c <= kMiddle + 4; ++c) expected.push_back(sheetParticle(c, kRow));
  EXPECT_EQ(sheet.set().group.particle, expected);
  Scene five = scene();
  five.suture->group_particles = 5;
  const PulledSheet printed(five, 4);
  EXPECT_EQ(printed.set().group.particle, std::vector<int>(expected.begin(), expected.begin() + 5));
}

TEST_P(GroupPullOf, DrawsItsParticlesEvenlyTowardsTheMiddle) {
  PulledSheet sheet(scene(), 4);
  sheet.draw(5e-3);
  sheet.run(1);
  const double part = 1 - 5e-3 / (4 * test::kSpacing);
  EXPECT_NEAR(sheet.set().group.drawn, 1 - part, 1e-9);
  EXPECT_LT(middleOf(sheet.set().group, sheet.state).head<2>().norm(), 1e-5);
  for (int k = 1; k <= 4; ++k) {
    const Eigen::Vector3d left = sheet.position(sheetParticle(kMiddle - k, kRow));
    const Eigen::Vector3d right = sheet.position(sheetParticle(kMiddle + k, kRow));
    EXPECT_LT((left + right).head<2>().norm(), 5e-5) << k << ", the box's sides are not mirrored";
    EXPECT_NEAR(left.z(), right.z(), 2e-5) << k;
    EXPECT_LT(right.x(), (part + 0.6 * (1 - part)) * k * test::kSpacing) << "two fifths of the way are done, " << k;
    EXPECT_GT(right.x(), (part - 1e-3) * k * test::kSpacing) << "no farther than its goal, " << k;
  }
  EXPECT_LT(sheet.position(sheetParticle(kMiddle + 6, kRow)).x(), 6 * test::kSpacing - 2e-4) << "the wall follows";
  EXPECT_GT(sheet.set().tension.front(), 0.1);
}

TEST_P(GroupPullOf, StopsAtTheStrainLimit) {
  double drawn[2];
  for (int wide = 0; wide < 2; ++wide) {
    Scene limited = scene();
    limited.suture->strain_limit = wide == 0 ? 0.15 : 0.3;
    PulledSheet sheet(limited, 4);
    sheet.draw(16e-3);
    sheet.run(1);
    const double strain = groupStrain(*sheet.model, sheet.state, sheet.set().group);
    EXPECT_GT(strain, 0.8 * limited.suture->strain_limit);
    EXPECT_LT(strain, 1.15 * limited.suture->strain_limit);
    drawn[wide] = sheet.set().pulled;
    EXPECT_LT(drawn[wide], 16e-3);
  }
  EXPECT_GT(drawn[1], 1.3 * drawn[0]);
}

TEST_P(GroupPullOf, StaysDrawnAfterTheCinch) {
  PulledSheet sheet(scene(), 4);
  sheet.draw(5e-3);
  sheet.set().stage = Suture::Stage::Cinched;
  sheet.run(1);
  const double apart = sheet.apart();
  sheet.run(3);
  EXPECT_NEAR(sheet.apart(), apart, 1e-5);
  sheet.set().stage = Suture::Stage::Broken;
  sheet.run(3);
  EXPECT_GT(sheet.apart(), apart + 2e-3) << "what does not pull lets go";
}

TEST_P(GroupPullOf, PushesAFreeSheetNowhere) {
  Scene free = scene();
  free.attach_oesophagus = false;
  free.tissue.mass_damping = 0;
  PulledSheet sheet(free, 4);
  // a set of three bites that no symmetry balances
  Bite bite = sheet.set().bites.front();
  bite.particle = {sheetParticle(kMiddle + 2, kRow + 3)};
  sheet.set().bites.push_back(bite);
  sheet.set().length.push_back(0.01), sheet.set().tension.push_back(0);
  findGroup(*sheet.model, sheet.state, sheet.set());
  sheet.draw(3e-3);
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  double size = 0;
  for (int i = 0; i < sheet.model->particle_count; ++i) {
    const Eigen::Vector3d v(sheet.state.vx[i], sheet.state.vy[i], sheet.state.vz[i]);
    sum += sheet.model->mass[i] * v, size += sheet.model->mass[i] * v.norm();
  }
  EXPECT_GT(size, 1e-5) << "something moves";
  EXPECT_LT(sum.norm(), 2e-3 * size) << "single precision";
}

TEST_P(GroupPullOf, EqualRunsHaveEqualBitsThroughASnapshotToo) {
  PulledSheet one(scene(), 4), two(scene(), 4);
  one.draw(3e-3), two.draw(3e-3);
  ASSERT_EQ(hash(one.state), hash(two.state));
  const std::string file = ::testing::TempDir() + "/group_pull_" + GetParam() + ".snapshot";
  saveSnapshot(*two.model, two.state, file);
  two.state = loadSnapshot(*two.model, file);
  std::remove(file.c_str());
  one.draw(2e-3), two.draw(2e-3);
  EXPECT_EQ(hash(one.state), hash(two.state));
  two.set().group.offset.front().x() += 1e-9;
  EXPECT_NE(hash(one.state), hash(two.state)) << "the group is part of the state";
}

TEST_P(GroupPullOf, KnowsTheWorkThatItDoes) {
  PulledSheet sheet(scene(), 4);
  const double before = sheet.model->tissue->energy(sheet.state);
  sheet.draw(5e-3, 3e-3);  // slowly, so that little swings
  sheet.run(1);
  const double stored = sheet.model->tissue->energy(sheet.state) - before;
  EXPECT_GT(stored, 1e-4);
  EXPECT_NEAR(sheet.state.energy.thread_work - sheet.state.energy.damping_loss, stored, 0.05 * stored);
}

TEST(GroupPull, IsTheSlopeOfItsEnergyAndTurnsWithTheSet) {
  PulledSheet sheet(sheetScene("shell", "groups"), 4);
  sheet.set().group.drawn = 0.3;
  // the whole sheet turned by 40 degrees since the group was found
  const Eigen::AngleAxisd turn(0.7, Eigen::Vector3d(1, 2, 3).normalized());
  std::vector<double> z;
  for (int i = 0; i < sheet.model->particle_count; ++i) {
    const Eigen::Vector3d p = turn * sheet.position(i);
    sheet.state.x[i] = p.x(), sheet.state.y[i] = p.y(), sheet.state.z[i] = p.z();
    for (const double value : {p.x(), p.y(), p.z(), 0.0}) z.push_back(value);
  }
  GroupPull pull;
  for (int k = 0; k < 4; ++k) pull.prepare(*sheet.model, sheet.state);
  ASSERT_EQ(pull.count(), 1);
  std::vector<float> gradient(z.size(), 0);
  const double energy = pull.evaluate(z.data(), gradient.data());
  double expected = 0;  // springs along the turned line, each 0.3 of its distance too long
  const double stiffness = sheet.model->scene.tissue.young_modulus * 2.3e-3;
  for (int k = 1; k <= 4; ++k) expected += stiffness * std::pow(0.3 * k * test::kSpacing, 2);
  EXPECT_NEAR(energy, expected, 1e-6 * expected);
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < z.size(); ++i) sum[static_cast<Eigen::Index>(i % 4 == 3 ? 0 : i % 4)] += gradient[i];
  EXPECT_LT(sum.norm(), 1e-5);
  for (const int node : sheet.set().group.particle)
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const std::size_t at = 4 * static_cast<std::size_t>(node) + axis;
      std::vector<float> none(z.size(), 0);
      std::vector<double> up = z, down = z;
      up[at] += 1e-5, down[at] -= 1e-5;
      const double slope = (pull.evaluate(up.data(), none.data()) - pull.evaluate(down.data(), none.data())) / 2e-5;
      EXPECT_NEAR(gradient[at], slope, 1e-4);
    }
}

TEST(GroupPull, IsAbsentWhereNothingPullsByGroups) {
  PulledSheet thread(sheetScene("shell", "thread"), 4);
  findGroup(*thread.model, thread.state, thread.set());
  GroupPull pull;
  pull.prepare(*thread.model, thread.state);
  EXPECT_EQ(pull.count(), 0) << "the scene asks for the thread";
  SumTerm terms;
  terms.add(nullptr);
  EXPECT_EQ(terms.simplest(), nullptr) << "the step has no further energy at all";
  PulledSheet groups(sheetScene("shell", "groups"), 4);
  groups.set().stage = Suture::Stage::Tagged;
  pull.prepare(*groups.model, groups.state);
  EXPECT_EQ(pull.count(), 0) << "the set does not pull yet";
  groups.set().stage = Suture::Stage::Cinched;
  pull.prepare(*groups.model, groups.state);
  EXPECT_EQ(pull.count(), 1);
  terms.add(&pull);
  EXPECT_EQ(terms.simplest(), &pull);
  terms.add(&pull);
  std::vector<double> z(4 * static_cast<std::size_t>(groups.model->particle_count), 0.0);
  std::vector<float> once(z.size(), 0), twice(z.size(), 0);
  EXPECT_DOUBLE_EQ(terms.simplest()->evaluate(z.data(), twice.data()), 2 * pull.evaluate(z.data(), once.data()));
}

}  // namespace
}  // namespace vibe::prototype::group_pull_test
