#include "vibe_core/suture/technique_patterns.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>

#include "vibe_core/program/error.hpp"

namespace vibe::technique_patterns_test {
namespace {

double meanSpacing(const std::vector<Eigen::Vector3d>& bites) {
  double path = 0;
  for (std::size_t k = 1; k < bites.size(); ++k) path += (bites[k] - bites[k - 1]).norm();
  return path / static_cast<double>(bites.size() - 1);
}

TEST(TechniquePatterns, HaveTheBitesAndSpacingAskedFor) {
  for (int t = 1; t < kTechniqueCount; ++t)
    for (int n = fewestBites(static_cast<Technique>(t)); n <= 9; ++n)
      for (std::uint64_t seed = 0; seed < 20; ++seed) {
        const TechniquePattern pattern = drawTechniquePattern(static_cast<Technique>(t), n, 0, seed);
        EXPECT_EQ(pattern.technique, static_cast<Technique>(t));
        ASSERT_EQ(pattern.bites.size(), static_cast<std::size_t>(n));
        // chords are shorter than the paths over the wall, and an ellipsoid narrows away from its equator
        EXPECT_GT(meanSpacing(pattern.bites), 0.6 * 0.010);
        EXPECT_LT(meanSpacing(pattern.bites), 1.05 * 0.020);
      }
}

TEST(TechniquePatterns, AreTheSameForTheSameSeedOnly) {
  const auto one = drawTechniquePattern(Technique::Z, 7, 0.15, 5).bites;
  EXPECT_EQ(one, drawTechniquePattern(Technique::Z, 7, 0.15, 5).bites);
  EXPECT_NE(one, drawTechniquePattern(Technique::Z, 7, 0.15, 6).bites);
}

TEST(TechniquePatterns, NoiseIsIsotropicAndOfTheSizeAskedFor) {
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  double expected = 0, count = 0;
  PatternRanges ranges;
  ranges.min_spacing = ranges.max_spacing = 0.012;
  for (std::uint64_t seed = 0; seed < 500; ++seed) {
    const auto clean = drawTechniquePattern(Technique::C, 7, 0, seed, ranges).bites;
    const auto noisy = drawTechniquePattern(Technique::C, 7, 0.15, seed, ranges).bites;
    for (int k = 0; k < 7; ++k, ++count) sum += (noisy[k] - clean[k]) * (noisy[k] - clean[k]).transpose();
    expected = std::pow(0.15 * 0.012, 2);
  }
  EXPECT_LT((sum / count - expected * Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff(), 0.08 * expected);
}

TEST(TechniquePatterns, LieOnACurvedWall) {
  int bent = 0;
  for (std::uint64_t seed = 0; seed < 100; ++seed) {
    const auto bites = drawTechniquePattern(Technique::Square, 9, 0, seed).bites;
    Eigen::MatrixXd rows(9, 3);
    for (int k = 0; k < 9; ++k) rows.row(k) = bites[k];
    rows.rowwise() -= rows.colwise().mean().eval();
    bent += rows.jacobiSvd().singularValues()[2] > 0.001;
  }
  EXPECT_GT(bent, 80);
}

TEST(TechniquePatterns, RefuseWhatCannotBeDrawn) {
  EXPECT_THROW(drawTechniquePattern(Technique::Other, 7, 0, 1), Error);
  EXPECT_THROW(drawTechniquePattern(Technique::Square, 4, 0, 1), Error);
  EXPECT_THROW(drawTechniquePattern(Technique::U, 3, 0, 1), Error);
  EXPECT_THROW(drawTechniquePattern(Technique::U, kTechniqueMaxBites + 1, 0, 1), Error);
  EXPECT_THROW(drawTechniquePattern(Technique::U, 7, -0.1, 1), Error);
  EXPECT_THROW(drawTechniquePattern(Technique::U, 7, std::numeric_limits<double>::quiet_NaN(), 1), Error);
}

TEST(Shuffled, KeepsTheBites) {
  const auto bites = drawTechniquePattern(Technique::U, 9, 0, 3).bites;
  const auto other = shuffled(bites, 4);
  EXPECT_NE(other, bites);
  for (const auto& bite : bites) EXPECT_EQ(std::count(other.begin(), other.end(), bite), 1);
  EXPECT_TRUE(shuffled({}, 1).empty());
}

}  // namespace
}  // namespace vibe::technique_patterns_test
