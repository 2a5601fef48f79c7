#include "vibe_core/suture/technique_table.hpp"

#include <gtest/gtest.h>

#include "vibe_core/suture/technique_patterns.hpp"

namespace vibe::technique_table_test {
namespace {

constexpr int kPerCell = 60;
constexpr std::uint64_t kSeed = 770077;  // the rule was not made with it

// bounds: what the project promises; not how well it happens to do
TEST(TechniqueTable, CorrectedRuleKeepsItsPromiseWithoutNoise) {
  const TechniqueTable table = measureTechnique(TechniqueRule::Corrected, 0, kPerCell, kSeed);
  EXPECT_GE(table.right(true), 0.99);
  EXPECT_GE(table.right(false), 0.99);
  for (int n = kTableMinBites; n <= kTableMaxBites; ++n) EXPECT_GE(table.right(true, n), 0.99) << n << " bites";
}

TEST(TechniqueTable, CorrectedRuleKeepsItsPromiseWithNoise) {
  const TechniqueTable table = measureTechnique(TechniqueRule::Corrected, 0.15, kPerCell, kSeed);
  EXPECT_GE(table.right(true), 0.95);
  EXPECT_GE(table.right(false), 0.95);
  for (int n = 5; n <= kTableMaxBites; ++n) EXPECT_GE(table.right(true, n), 0.93) << n << " bites";
  EXPECT_GE(table.right(true, 4), 0.88);  // noise moves three chords of an arc as far as three sides of a square
}

TEST(TechniqueTable, PrintedRuleRecognisesNoU) {
  const TechniqueTable table = measureTechnique(TechniqueRule::Printed, 0, kPerCell, kSeed);
  int seen = 0;
  for (const auto& by_bites : table.count)
    seen += by_bites[static_cast<int>(Technique::U)][static_cast<int>(Technique::U)];
  EXPECT_LT(seen, table.drawn(Technique::U) / 100);
  EXPECT_LT(table.right(true), 0.9);
}

// control: it is the order of bites that makes a technique
TEST(TechniqueTable, ShuffledBitesAreMostlyNoUOrZ) {
  int called = 0, all = 0;
  for (int n = 6; n <= 9; ++n)
    for (int t = 1; t < kTechniqueCount; ++t)
      for (std::uint64_t k = 0; k < 20; ++k, ++all) {
        const auto bites = drawTechniquePattern(static_cast<Technique>(t), n, 0, 8800 + k).bites;
        const Technique answer = recogniseTechnique(shuffled(bites, 99 + k)).technique;
        called += answer == Technique::U || answer == Technique::Z;
      }
  EXPECT_LT(called, all / 5);
}

TEST(TechniqueTable, CountsWhatWasDrawn) {
  const TechniqueTable table = measureTechnique(TechniqueRule::Printed, 0, 3, 1);
  EXPECT_EQ(table.drawn(Technique::U), 18);
  EXPECT_EQ(table.drawn(Technique::Square), 15);  // none with four bites
  EXPECT_EQ(table.drawn(Technique::Other), 0);
  TechniqueTable own;
  own.count[0][1][1] = 6, own.count[0][3][4] = 3, own.count[0][2][5] = 1;
  EXPECT_DOUBLE_EQ(own.right(true), 0.9);
  EXPECT_DOUBLE_EQ(own.right(false, 4), 0.6);
  EXPECT_EQ(own.right(true, 5), 0);
}

TEST(TechniqueTable, ReportShowsBothRules) {
  const std::string report = techniqueReport(2, 1);
  EXPECT_NE(report.find("| corrected | 15.0 | 6 |"), std::string::npos);
  EXPECT_NE(report.find("| printed | 0.0 | 3 |"), std::string::npos);
  EXPECT_NE(report.find("| square |"), std::string::npos);
}

}  // namespace
}  // namespace vibe::technique_table_test
