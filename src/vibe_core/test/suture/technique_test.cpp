#include "vibe_core/suture/technique.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "vibe_core/suture/technique_patterns.hpp"

namespace vibe::technique_test {
namespace {

using Eigen::Vector3d;
using Bites = std::vector<Vector3d>;

Bites flat(const std::vector<std::array<double, 2>>& points) {
  Bites bites;
  for (const auto& p : points) bites.emplace_back(0.015 * p[0], 0.015 * p[1], 0);
  return bites;
}

Technique recognised(const std::vector<std::array<double, 2>>& points) {
  return recogniseTechnique(flat(points)).technique;
}

Bites arcOf(int count, double degrees) {
  Bites bites;
  for (int k = 0; k < count; ++k) {
    const double angle = degrees * M_PI / 180 * k / (count - 1);
    bites.emplace_back(0.03 * std::cos(angle), 0.03 * std::sin(angle), 0);
  }
  return bites;
}

TEST(Technique, TellsLettersApart) {
  EXPECT_EQ(recognised({{0, 1}, {0, 0}, {1, 0}, {1, 1}}), Technique::U);
  EXPECT_EQ(recognised({{0, 2}, {0, 1}, {0, 0}, {1, 0}, {1, 1}, {1, 2}}), Technique::U);
  EXPECT_EQ(recognised({{0, 3}, {0, 2}, {0, 1}, {0, 0}, {1, 0}, {1, 2}, {1, 3}}), Technique::U);
  EXPECT_EQ(recognised({{0, 1}, {1, 1}, {0, 0}, {1, 0}}), Technique::Z);
  EXPECT_EQ(recognised({{0, 2}, {1, 2}, {2, 2}, {1, 1}, {0, 0}, {1, 0}, {2, 0}}), Technique::Z);
  EXPECT_EQ(recognised({{0, 0}, {1, 0}, {2, 0}, {1.5, 0.87}, {1, 1.73}}), Technique::Triangular);
  EXPECT_EQ(recognised({{0, 0}, {1, 0}, {0.5, 0.87}, {0, 0}}), Technique::Triangular);
  EXPECT_EQ(recognised({{0, 0}, {1, 0}, {2, 0}, {1.5, 0.87}, {1, 1.73}, {0.5, 0.87}}), Technique::Triangular);
  EXPECT_EQ(recognised({{0, 0}, {1, 0}, {1, 1}, {0, 1}, {0, 0}}), Technique::Square);
  EXPECT_EQ(recognised({{0, 0}, {1, 0}, {2, 0}, {2, 1}, {2, 2}, {1, 2}, {0, 2}, {0, 1}}), Technique::Square);
  EXPECT_EQ(recognised({{0, 0}, {1, 0}, {2, 0}, {3, 0}}), Technique::Running);
  EXPECT_EQ(recognised({{0, 0}, {1, 0.3}, {2, 0}, {3, 0.3}, {4, 0}, {5, 0.3}, {6, 0}}), Technique::Running);
  EXPECT_EQ(recogniseTechnique(arcOf(4, 180)).technique, Technique::C);
  EXPECT_EQ(recogniseTechnique(arcOf(7, 180)).technique, Technique::C);
  EXPECT_EQ(recogniseTechnique(arcOf(7, 270)).technique, Technique::C);
}

TEST(Technique, FourBitesOnThreeQuartersOfACircleAreAU) {
  EXPECT_EQ(recogniseTechnique(arcOf(4, 270)).technique, Technique::U);
}

// an anterior and a posterior row around a tube, 110 degrees long: seen from any side much of it is hidden
TEST(Technique, SeesAUThatGoesAroundTheOrgan) {
  Bites bites;
  for (int k = 0; k <= 4; ++k) bites.emplace_back(0.04 * std::cos(0.48 * k), 0.04 * std::sin(0.48 * k), 0);
  for (int k = 4; k >= 0; --k) bites.emplace_back(0.04 * std::cos(0.48 * k), 0.04 * std::sin(0.48 * k), 0.014);
  const TechniqueResult result = recogniseTechnique(bites);
  EXPECT_EQ(result.technique, Technique::U);
  EXPECT_EQ(result.transitions, (std::array<int, 2>{3, 4}));
}

TEST(Technique, NamesTheCornersOfUAndZ) {
  const auto u = recogniseTechnique(flat({{0, 2}, {0, 1}, {0, 0}, {1, 0}, {1, 1}, {1, 2}}));
  EXPECT_EQ(u.transitions, (std::array<int, 2>{1, 2}));  // at bites 2 and 3
  const auto z = recogniseTechnique(flat({{0, 1}, {1, 1}, {0, 0}, {1, 0}}));
  EXPECT_EQ(z.transitions, (std::array<int, 2>{0, 1}));
  EXPECT_EQ(recogniseTechnique(arcOf(7, 200)).transitions, (std::array<int, 2>{-1, -1}));
}

TEST(Technique, PrintedRuleSeesAZWithSharpCornersOnly) {
  const auto printed = [](const auto& points) { return recogniseTechnique(flat(points), TechniqueRule::Printed); };
  using Points = std::vector<std::array<double, 2>>;
  // diagonal at 45 degrees: d = -0.707 at both corners, d_1n = 1
  const auto sharp = printed(Points{{0, 1}, {1, 1}, {0, 0}, {1, 0}});
  EXPECT_EQ(sharp.technique, Technique::Z);
  EXPECT_EQ(sharp.transitions, (std::array<int, 2>{0, 1}));
  EXPECT_NEAR(sharp.margin, std::sqrt(0.5) - 0.5, 1e-12);
  // corners of 65 degrees inside: d = -0.42
  EXPECT_EQ(printed(Points{{0, 2}, {2, 2}, {1.07, 0}, {3.07, 0}}).technique, Technique::Other);
}

// d <= -0.5 at both corners means that the first and the last vector lie within 60 degrees of the reversed middle one,
// hence within 120 degrees of each other: d_1n >= -0.5, and never below -0.7
TEST(Technique, PrintedRuleCannotSeeAnyUOfFourBites) {
  int z = 0;
  for (int k = 0; k < 20000; ++k) {
    Bites bites;
    for (int b = 0; b < 4; ++b)
      bites.emplace_back(std::fmod(k * 0.618 + b * 0.7321, 1), std::fmod(k * 0.4142 + b * 0.2361, 1),
                         std::fmod(k * 0.2719 + b * b * 0.5772, 1));
    const Technique answer = recogniseTechnique(bites, TechniqueRule::Printed).technique;
    EXPECT_NE(answer, Technique::U);
    z += answer == Technique::Z;
  }
  EXPECT_GT(z, 100);  // it does see something
}

// the disagreement of the paper's text and equation 2: here d = 0 at both corners
TEST(Technique, PrintedRuleCannotSeeARightAngledU) {
  const Bites u = flat({{0, 1}, {0, 0}, {1, 0}, {1, 1}});
  EXPECT_EQ(recogniseTechnique(u, TechniqueRule::Printed).technique, Technique::Other);
  EXPECT_EQ(recogniseTechnique(u, TechniqueRule::Corrected).technique, Technique::U);
  const Bites longer = flat({{0, 2}, {0, 1}, {0, 0}, {1, 0}, {1, 1}, {1, 2}});
  EXPECT_EQ(recogniseTechnique(longer, TechniqueRule::Printed).technique, Technique::Other);
  EXPECT_EQ(recogniseTechnique(longer).technique, Technique::U);
}

TEST(Technique, IsOtherWithoutMarginWhereNothingCanBeSaid) {
  const double nan = std::numeric_limits<double>::quiet_NaN(), huge = 1e308;
  const Bites square = flat({{0, 0}, {1, 0}, {1, 1}, {0, 1}, {0, 0}});
  std::vector<Bites> cases{{},
                           {{0, 0, 0}},
                           Bites(square.begin(), square.begin() + 3),
                           Bites(7, Vector3d(1, 2, 3)),
                           Bites(5000, Vector3d(1, 2, 3))};
  for (int k = 0; k < 5; ++k) {
    cases.push_back(square);
    cases.back()[k].z() = k % 2 == 0 ? nan : std::numeric_limits<double>::infinity();
  }
  cases.push_back({{huge, 0, 0}, {-huge, 0, 0}, {0, huge, 0}, {0, 0, huge}});
  Bites many;
  for (int k = 0; k < 5000; ++k) many.emplace_back(k, k % 7, k % 3);
  cases.push_back(many);
  for (const Bites& bites : cases)
    for (const TechniqueRule rule : {TechniqueRule::Corrected, TechniqueRule::Printed}) {
      const TechniqueResult result = recogniseTechnique(bites, rule);
      EXPECT_EQ(result.technique, Technique::Other) << bites.size();
      EXPECT_EQ(result.margin, 0) << bites.size();
      EXPECT_EQ(result.transitions, (std::array<int, 2>{-1, -1}));
    }
}

TEST(Technique, TakesDegenerateSets) {
  for (const double tiny : {0.0, 1e-300, 1e-12, 1.0}) {
    Bites line, pair;
    for (int k = 0; k < 7; ++k) line.emplace_back(k * tiny, 0, 0), pair.emplace_back(0, k < 3 ? tiny : 0, 0);
    for (const Bites& bites : {line, pair})
      for (const TechniqueRule rule : {TechniqueRule::Corrected, TechniqueRule::Printed}) {
        const TechniqueResult result = recogniseTechnique(bites, rule);
        EXPECT_GE(result.margin, 0);
        EXPECT_LE(result.margin, 1);
      }
  }
}

TEST(Technique, MarginGrowsWithClarity) {
  EXPECT_GT(recogniseTechnique(flat({{0, 2}, {0, 1}, {0, 0}, {1, 0}, {1, 1}, {1, 2}})).margin, 0.95);
  // from a U to a half circle on the way between the two
  double min = 1;
  for (double share = 0; share <= 1; share += 0.02) {
    const Bites u = flat({{-1, 2}, {-1, 1}, {-1, 0}, {1, 0}, {1, 1}, {1, 2}});
    Bites mixed;
    for (int k = 0; k < 6; ++k) {
      const double angle = M_PI * (1 + k / 5.0);
      mixed.push_back((1 - share) * u[k] + share * 0.03 * Vector3d(std::cos(angle), 1 + std::sin(angle), 0));
    }
    min = std::min(min, recogniseTechnique(mixed).margin);
  }
  EXPECT_LT(min, 0.15);
}

// what the margin is for: a user who leaves doubtful answers out leaves most wrong ones out
TEST(Technique, WrongAnswersHaveSmallMargins) {
  int right = 0, right_sure = 0, wrong = 0, wrong_sure = 0;
  for (int n = 4; n <= 9; ++n)
    for (int t = 1; t < kTechniqueCount; ++t)
      for (std::uint64_t seed = 0; n >= fewestBites(static_cast<Technique>(t)) && seed < 60; ++seed) {
        const TechniquePattern pattern = drawTechniquePattern(static_cast<Technique>(t), n, 0.15, 52000 + seed);
        const TechniqueResult result = recogniseTechnique(pattern.bites);
        const bool sure = result.margin > 0.9;
        ++(result.technique == pattern.technique ? right : wrong);
        (result.technique == pattern.technique ? right_sure : wrong_sure) += sure;
      }
  EXPECT_GT(right_sure, 0.7 * right);
  EXPECT_LT(wrong_sure, 0.25 * wrong);
}

class EveryTechnique : public testing::TestWithParam<int> {};

TEST_P(EveryTechnique, DoesNotChangeWithPoseMirrorScaleAndOrder) {
  const Technique technique = static_cast<Technique>(GetParam());
  for (int n = fewestBites(technique); n <= 9; ++n)
    for (std::uint64_t seed = 0; seed < 12; ++seed) {
      const Bites bites = drawTechniquePattern(technique, n, 0.1, 41000 + seed).bites;
      const TechniqueResult expected = recogniseTechnique(bites);
      const Eigen::Matrix3d turn =
          Eigen::Quaterniond(0.3, -0.7, 0.2 * static_cast<double>(seed), 0.5).normalized().toRotationMatrix();
      Bites moved, mirrored, small, back = bites;
      for (const Vector3d& b : bites) {
        moved.push_back(turn * b + Vector3d(3, -2, 5));
        mirrored.emplace_back(-b.x(), b.y(), b.z());
        small.push_back(1e-6 * b);
      }
      std::reverse(back.begin(), back.end());
      for (const Bites& other : {moved, mirrored, small, back}) {
        const TechniqueResult result = recogniseTechnique(other);
        EXPECT_EQ(result.technique, expected.technique) << "seed " << seed << ", " << n << " bites";
        EXPECT_NEAR(result.margin, expected.margin, 1e-6) << "seed " << seed << ", " << n << " bites";
      }
      if (expected.transitions[0] >= 0) {
        const auto [first, second] = recogniseTechnique(back).transitions;
        EXPECT_EQ(first, n - 3 - expected.transitions[1]);
        EXPECT_EQ(second, n - 3 - expected.transitions[0]);
      }
    }
}

INSTANTIATE_TEST_SUITE_P(Technique, EveryTechnique, testing::Range(1, kTechniqueCount),
                         [](const auto& p) { return std::string(toString(static_cast<Technique>(p.param))); });

}  // namespace
}  // namespace vibe::technique_test
