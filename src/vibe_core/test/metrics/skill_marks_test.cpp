#include "vibe_core/metrics/skill_acts.hpp"

#include <gtest/gtest.h>

#include "metrics/organs.hpp"

namespace vibe::skill_marks_test {
namespace {

/// A tube whose walls are its quarters; 20 rings of 40 particles, after the cap at z = 0.
class MarkSkillTest : public ::testing::Test {
 protected:
  static constexpr int kRings = 20, kSectors = 40;
  Organ organ = test::revolve([](double) { return 0.03; }, 0.2, kRings, kSectors);
  std::vector<std::uint8_t> grade;

  void SetUp() override {
    grade.assign(organ.surface.vertices.size(), 0);
    for (std::size_t v = 0; v < grade.size(); ++v) {
      const Eigen::Vector3d& p = organ.surface.vertices[v];
      const double angle = std::atan2(p.y(), p.x()) + M_PI;
      organ.wall[v] = static_cast<Wall>(std::min(3, static_cast<int>(angle / (M_PI / 2))));
      if (p.z() < -0.15) organ.region[v] = Region::Antrum;
    }
  }
  /// The particle nearest to a place on the tube.
  int at(double angle, double z) const {
    const Eigen::Vector3d place(0.03 * std::cos(angle - M_PI), 0.03 * std::sin(angle - M_PI), z);
    int best = 0;
    for (int v = 0; v < static_cast<int>(grade.size()); ++v)
      if ((organ.surface.vertices[v] - place).norm() < (organ.surface.vertices[best] - place).norm()) best = v;
    return best;
  }
  void mark(double angle, double z, BurnGrade how = BurnGrade::Mark) {
    grade[at(angle, z)] = static_cast<std::uint8_t>(how);
  }
  MarkSkill count() const {
    const test::Positions p(organ, [](const Eigen::Vector3d& x) { return x; });
    return MarkCounter(organ).count(grade, p.x, p.y, p.z);
  }
};

TEST_F(MarkSkillTest, ofAnUnmarkedWallIsNothing) {
  EXPECT_EQ(count().zones, 0);
  EXPECT_EQ(count().area, 0);
}

TEST_F(MarkSkillTest, countsPlacesNotParticles) {
  mark(0.8, -0.05);
  EXPECT_EQ(count().zones, 1);
  mark(0.8, -0.06);  // the next ring: the same mark, longer
  EXPECT_EQ(count().zones, 1);
  mark(0.8, -0.10);
  EXPECT_EQ(count().zones, 2);
  EXPECT_EQ(count().inside, 2);
}

TEST_F(MarkSkillTest, tellsWallsAndTheZoneApart) {
  for (double z : {-0.03, -0.06, -0.09}) mark(0.8, z);  // anterior
  for (double z : {-0.03, -0.06}) mark(2.4, z);         // greater curvature
  mark(4.0, -0.06);                                     // posterior
  mark(5.5, -0.06);                                     // lesser curvature: not to be marked
  mark(0.8, -0.18);                                     // antrum: neither
  const MarkSkill skill = count();
  EXPECT_EQ(skill.wall, (std::array<int, kWallCount>{4, 2, 1, 1}));
  EXPECT_EQ(skill.zones, 8);
  EXPECT_EQ(skill.inside, 6);
  EXPECT_EQ(skill.burns + skill.deep_burns, 0);
}

TEST_F(MarkSkillTest, aZoneIsAsBadAsItsWorstParticle) {
  mark(0.8, -0.05);
  mark(0.8, -0.06, BurnGrade::Burn);
  mark(2.4, -0.05, BurnGrade::Deep);
  mark(4.0, -0.05);
  EXPECT_EQ(count().zones, 3);
  EXPECT_EQ(count().burns, 2);
  EXPECT_EQ(count().deep_burns, 1);
}

TEST_F(MarkSkillTest, areaIsThatOfTheMarkedParticles) {
  mark(0.8, -0.05);
  const double cell = (2 * M_PI * 0.03 / kSectors) * (0.2 / kRings);
  EXPECT_NEAR(count().area, cell, 0.01 * cell);
}

TEST_F(MarkSkillTest, aSceneWithoutMarkingHasNone) {
  mark(0.8, -0.05);
  grade.clear();
  EXPECT_EQ(count().zones, 0);
}

}  // namespace
}  // namespace vibe::skill_marks_test
