// Planned patterns are what they are called, for the recogniser that judges the bites.
#include "vibe_core/trainee/suture_pattern.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "vibe_core/program/error.hpp"
#include "vibe_core/suture/technique_patterns.hpp"

namespace vibe::suture_pattern_test {
namespace {

std::vector<Eigen::Vector3d> onCylinder(const std::vector<Eigen::Vector2d>& places, double radius) {
  std::vector<Eigen::Vector3d> bites;
  for (const Eigen::Vector2d& place : places)
    bites.emplace_back(place.x(), radius * std::sin(place.y() / radius), radius * std::cos(place.y() / radius));
  return bites;
}

TEST(SuturePattern, IsRecognisedAsPlanned) {
  for (int t = 1; t < kTechniqueCount; ++t) {
    const Technique technique = static_cast<Technique>(t);
    // from 7 bites on all techniques can be told apart (docs/technique.md)
    for (int bites = 7; bites <= 9; ++bites) {
      const double length = technique == Technique::U ? 25e-3 : 40e-3;
      const auto places = suturePattern(technique, bites, length, technique == Technique::Running ? 0.01 : 45e-3);
      ASSERT_EQ(places.size(), static_cast<std::size_t>(bites));
      EXPECT_EQ(recogniseTechnique(onCylinder(places, 45e-3)).technique, technique)
          << toString(technique) << ", " << bites << " bites";
    }
  }
}

TEST(SuturePattern, HasTheSizeThatIsAskedFor) {
  const auto places = suturePattern(Technique::U, 7, 20e-3, 60e-3);
  Eigen::Vector2d min = places.front(), max = places.front();
  for (const Eigen::Vector2d& place : places) min = min.cwiseMin(place), max = max.cwiseMax(place);
  EXPECT_NEAR((max - min).x(), 20e-3, 1e-12);
  EXPECT_NEAR((max - min).y(), 60e-3, 1e-12);
  EXPECT_NEAR((max + min).norm(), 0, 1e-12) << "around its centre";
}

TEST(SuturePattern, SaysWhatDoesNotExist) {
  EXPECT_THROW(suturePattern(Technique::Square, 4, 0.02, 0.02), Error) << "three sides are a U";
  EXPECT_THROW(suturePattern(Technique::Other, 6, 0.02, 0.02), Error);
  EXPECT_THROW(suturePattern(Technique::U, kTechniqueMaxBites + 1, 0.02, 0.02), Error);
}

}  // namespace
}  // namespace vibe::suture_pattern_test
