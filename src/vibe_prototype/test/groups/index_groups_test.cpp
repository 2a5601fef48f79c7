#include "groups/index_groups.hpp"
#include "groups/group_draw.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "vibe_core/program/error.hpp"

namespace vibe::prototype::index_groups_test {
namespace {

using Eigen::Vector3d;
using Bites = std::vector<Vector3d>;
using Groups = std::vector<std::vector<int>>;

constexpr double kSpacing = 0.004;

struct Wall {
  std::vector<double> x, y, z;
  void add(const Vector3d& p) { x.push_back(p.x()), y.push_back(p.y()), z.push_back(p.z()); }
  Vector3d at(int k) const { return {x[k], y[k], z[k]}; }
  ParticlePositions positions() const { return {x, y, z}; }
};

/// 21 x 21 particles; particle 21 * row + column.
Wall plate(const Vector3d& origin = Vector3d::Zero()) {
  Wall wall;
  for (int row = 0; row < 21; ++row)
    for (int column = 0; column < 21; ++column) wall.add(origin + kSpacing * Vector3d(column, row, 0));
  return wall;
}

Vector3d plateAt(double column, double row) {
  return kSpacing * Vector3d(column, row, 0);
}

constexpr double kRadius = 0.04;
constexpr int kAround = 60;  // 4.2 mm apart

Wall tube() {
  Wall wall;
  for (int ring = 0; ring < 21; ++ring)
    for (int k = 0; k < kAround; ++k) {
      const double angle = 2 * M_PI * k / kAround;
      wall.add({kRadius * std::cos(angle), kRadius * std::sin(angle), kSpacing * ring});
    }
  return wall;
}

Vector3d tubeAt(int around, int ring) {
  const double angle = 2 * M_PI * around / kAround;
  return {kRadius * std::cos(angle), kRadius * std::sin(angle), kSpacing * ring};
}

IndexGroupSettings settings() {
  IndexGroupSettings s;
  s.ray_radius = kSpacing / 2;
  return s;
}

TechniqueResult as(Technique technique, int first = -1, int second = -1) {
  return {technique, 1, {first, second}};
}

std::vector<int> column(int number, int from_row, int to_row) {
  std::vector<int> particles;
  const int step = from_row < to_row ? 1 : -1;
  for (int row = from_row; row != to_row + step; row += step) particles.push_back(21 * row + number);
  return particles;
}

std::vector<int> row(int number, int from_column, int to_column) {
  std::vector<int> particles;
  const int step = from_column < to_column ? 1 : -1;
  for (int k = from_column; k != to_column + step; k += step) particles.push_back(21 * number + k);
  return particles;
}

// (2, 10) -> (10, 10) -> (2, 2) -> (10, 2): the sides that close the letter are columns 2 and 10
TEST(IndexGroups, OfAZAreThePaperRays) {
  const Bites bites{plateAt(2, 10), plateAt(10, 10), plateAt(2, 2), plateAt(10, 2)};
  const Wall wall = plate();
  const Groups groups = indexGroups(wall.positions(), bites, as(Technique::Z, 0, 1), settings());
  EXPECT_EQ(groups, (Groups{column(2, 10, 2), column(10, 10, 2)}));
}

TEST(IndexGroups, OfAUAreThePrintedOnesOrItsLegs) {
  const Bites bites{plateAt(2, 10), plateAt(2, 6), plateAt(2, 2), plateAt(8, 2), plateAt(8, 6), plateAt(8, 10)};
  const Wall wall = plate();
  IndexGroupSettings s = settings();
  EXPECT_EQ(indexGroups(wall.positions(), bites, as(Technique::U, 1, 2), s), (Groups{column(2, 10, 6), row(2, 2, 8)}));
  s.whole_legs = true;
  EXPECT_EQ(indexGroups(wall.positions(), bites, as(Technique::U, 1, 2), s),
            (Groups{column(2, 10, 2), column(8, 2, 10)}));
}

TEST(IndexGroups, OfOtherTechniquesAreTheFirstFewPerPairOfBites) {
  const Bites bites{plateAt(0, 0), plateAt(10, 0), plateAt(10, 3)};
  const Wall wall = plate();
  IndexGroupSettings s = settings();
  EXPECT_EQ(indexGroups(wall.positions(), bites, as(Technique::Triangular), s),
            (Groups{row(0, 0, 4), column(10, 0, 3)}));
  s.particle_limit = 2;
  EXPECT_EQ(indexGroups(wall.positions(), bites, as(Technique::Other), s), (Groups{row(0, 0, 1), column(10, 0, 1)}));
  EXPECT_TRUE(indexGroups(wall.positions(), {bites[0]}, as(Technique::Other), s).empty());
}

TEST(IndexGroups, ParticleOfTwoRaysBelongsToTheFirst) {
  const Bites bites{plateAt(0, 0), plateAt(3, 0), plateAt(3, 4)};
  const Wall wall = plate();
  EXPECT_EQ(indexGroups(wall.positions(), bites, as(Technique::Other), settings()),
            (Groups{row(0, 0, 3), column(3, 1, 4)}));
}

// within the rounding of single precision a plate far away would be a heap of points
TEST(IndexGroups, DoNotDependOnTheOrigin) {
  const Vector3d far(5000, -3000, 800);
  const Bites bites{far + plateAt(0, 0), far + plateAt(10, 0), far + plateAt(10, 3)};
  const Wall wall = plate(far);
  EXPECT_EQ(indexGroups(wall.positions(), bites, as(Technique::Other), settings()),
            (Groups{row(0, 0, 4), column(10, 0, 3)}));
}

TEST(IndexGroups, MatchATestOfEveryParticle) {
  const Wall wall = plate();
  IndexGroupSettings s = settings();
  s.particle_limit = 1000;
  s.follow_wall = false;
  for (int k = 0; k < 40; ++k) {
    const Vector3d from = plateAt(20 * std::fmod(k * 0.618, 1), 20 * std::fmod(k * 0.414, 1));
    const Vector3d to = plateAt(20 * std::fmod(k * 0.732, 1), 20 * std::fmod(k * 0.236, 1)) + Vector3d(0, 0, 1e-3);
    std::vector<int> expected;
    for (int p = 0; p < 21 * 21; ++p) {
      const Vector3d d = to - from, q = wall.at(p) - from;
      const double t = d.squaredNorm() > 0 ? std::clamp(q.dot(d) / d.squaredNorm(), 0.0, 1.0) : 0;
      if ((q - t * d).norm() <= s.ray_radius) expected.push_back(p);
    }
    auto found = indexGroups(wall.positions(), {from, to}, as(Technique::Other), s)[0];
    std::sort(found.begin(), found.end());
    ASSERT_FALSE(expected.empty());
    EXPECT_EQ(found, expected) << "ray " << k;
  }
}

// a chord over 96 degrees of the tube passes 13 mm under the wall
TEST(IndexGroups, FollowACurvedWall) {
  const Wall wall = tube();
  const Bites bites{tubeAt(2, 5), tubeAt(18, 5), tubeAt(18, 12), tubeAt(2, 12)};
  IndexGroupSettings s = settings();
  s.ray_radius = 0.0022;
  s.whole_legs = true;
  const Groups bent = indexGroups(wall.positions(), bites, as(Technique::U, 0, 1), s);
  ASSERT_EQ(bent.size(), 2u);
  std::vector<int> leg;
  for (int k = 2; k <= 18; ++k) leg.push_back(5 * kAround + k);
  EXPECT_EQ(bent[0], leg);
  EXPECT_EQ(bent[1].size(), leg.size());

  s.follow_wall = false;
  const Groups straight = indexGroups(wall.positions(), bites, as(Technique::U, 0, 1), s);
  EXPECT_EQ(straight[0], (std::vector<int>{leg.front(), leg.back()}));
}

TEST(IndexGroups, NeverEmptyForBitesOffTheWall) {
  const Wall wall = plate();
  const Bites bites{plateAt(2, 2) + Vector3d(0, 0, 0.05), plateAt(8, 2) + Vector3d(0, 0, 0.05)};
  const Groups groups = indexGroups(wall.positions(), bites, as(Technique::Other), settings());
  ASSERT_EQ(groups.size(), 1u);
  EXPECT_EQ(groups[0][0], 21 * 2 + 2);
}

TEST(IndexGroups, TakeBitesInOnePlace) {
  const Wall wall = plate();
  const Groups groups = indexGroups(wall.positions(), {plateAt(3, 3), plateAt(3, 3)}, as(Technique::Other), settings());
  EXPECT_EQ(groups, (Groups{{21 * 3 + 3}}));
}

TEST(IndexGroups, RefuseWhatCannotBeMeant) {
  Wall wall = plate();
  const Bites bites{plateAt(2, 10), plateAt(10, 10), plateAt(2, 2), plateAt(10, 2)};
  const auto groups = [&](const Bites& b, const TechniqueResult& t, const IndexGroupSettings& s) {
    return indexGroups(wall.positions(), b, t, s);
  };
  EXPECT_THROW(groups(bites, as(Technique::Z), settings()), Error);
  EXPECT_THROW(groups(bites, as(Technique::Z, 0, 3), settings()), Error);
  EXPECT_THROW(groups(bites, as(Technique::U, 1, 1), settings()), Error);
  EXPECT_THROW(groups(bites, as(Technique::Other), IndexGroupSettings{}), Error);
  Bites broken = bites;
  broken[1].y() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(groups(broken, as(Technique::Other), settings()), Error);
  wall.z[7] = std::numeric_limits<double>::infinity();
  EXPECT_THROW(groups(bites, as(Technique::Other), settings()), Error);
  wall.z.pop_back();
  EXPECT_THROW(groups(bites, as(Technique::Other), settings()), Error);
}

TEST(MiddleOf, IsTheMeanOfTheBites) {
  EXPECT_EQ(middleOf({{0, 0, 0}, {2, 0, 0}, {1, 3, 6}}), Vector3d(1, 1, 2));
  EXPECT_EQ(middleOf({}), Vector3d(0, 0, 0));
}

}  // namespace
}  // namespace vibe::prototype::index_groups_test
