#include "vibe_core/metrics/skill_acts.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "vibe_testing/worlds.hpp"

namespace vibe::skill_sutures_test {
namespace {

/// A wall whose particles lie on a line, one per centimetre, and sets on it.
class SutureSkill : public ::testing::Test {
 protected:
  Organ organ;
  SutureScene scene;
  std::vector<Suture> sutures;

  SutureSkill() {
    for (int k = 0; k < 20; ++k) organ.surface.vertices.emplace_back(0.01 * k, 0, 0);
  }

  static Bite bite(int particle, double along, double depth = 3e-3) {
    Bite result;
    result.particle = {particle};
    result.weight = {1};
    result.along = along;
    result.depth = depth;
    result.thickness = 2e-3;
    return result;
  }
  /// Bites at these particles, each so far along the axis.
  Suture& add(std::initializer_list<std::pair<int, double>> places) {
    Suture& suture = sutures.emplace_back();
    for (const auto& [particle, along] : places) suture.bites.push_back(bite(particle, along));
    if (!suture.bites.empty()) suture.length.assign(suture.bites.size() - 1, 0.012);
    suture.tension.assign(suture.length.size(), 0);
    return suture;
  }
  BiteSkill bites() const { return measureBites(organ, sutures); }
  std::vector<SetSkill> sets() const {
    std::vector<SetSkill> result;
    measureSets(organ, &scene, sutures, result);
    return result;
  }
};

TEST_F(SutureSkill, ofNoBitesIsUndefined) {
  const BiteSkill b = bites();
  EXPECT_EQ(b.taken, 0);
  EXPECT_FALSE(b.spacing_mean || b.spacing_sd || b.depth_mean || b.depth_sd);
  EXPECT_FALSE(b.full_thickness_share || b.bites_proximal || b.sets_proximal);
  EXPECT_TRUE(sets().empty());
}

TEST_F(SutureSkill, ofOneBiteHasADepthAndNoSpread) {
  add({{3, 0.5}});
  EXPECT_DOUBLE_EQ(*bites().depth_mean, 3e-3);
  EXPECT_FALSE(bites().depth_sd || bites().spacing_mean || bites().bites_proximal);
  EXPECT_FALSE(sets()[0].thread.has_value());
}

TEST_F(SutureSkill, spacingIsBetweenNeighboursOfASetOnly) {
  add({{0, 0.9}, {1, 0.8}, {4, 0.7}});  // 1 cm, 3 cm
  add({{19, 0.6}, {17, 0.5}});          // 2 cm; from 4 to 19 there is no thread
  EXPECT_NEAR(*bites().spacing_mean, 0.02, 1e-12);
  EXPECT_NEAR(*bites().spacing_sd, 0.01, 1e-12);
  EXPECT_NEAR(*sets()[0].spacing_mean, 0.02, 1e-12);
  EXPECT_NEAR(*sets()[1].spacing_mean, 0.02, 1e-12);
}

TEST_F(SutureSkill, spacingTakesTheWeightedPlaceOfABite) {
  add({{0, 0.9}, {4, 0.8}});
  sutures[0].bites[1].particle = {4, 5};
  sutures[0].bites[1].weight = {0.75, 0.25};
  EXPECT_NEAR(*bites().spacing_mean, 0.0425, 1e-12);
}

TEST_F(SutureSkill, depthsAndFullThickness) {
  Suture& suture = add({{0, 0.9}, {1, 0.8}, {2, 0.7}, {3, 0.6}});
  const double depths[] = {1e-3, 2e-3, 3e-3, 6e-3};
  for (int k = 0; k < 4; ++k) suture.bites[k].depth = depths[k];
  EXPECT_NEAR(*bites().depth_mean, 3e-3, 1e-12);
  EXPECT_NEAR(*bites().depth_sd, std::sqrt(14.0 / 3) * 1e-3, 1e-12);
  EXPECT_EQ(bites().full_thickness, 3);
  EXPECT_DOUBLE_EQ(*bites().full_thickness_share, 0.75);
}

TEST_F(SutureSkill, tellsDistalToProximalFromTheOtherWay) {
  add({{0, 0.9}, {1, 0.8}, {2, 0.8}});
  add({{3, 0.6}, {4, 0.5}});
  add({{5, 0.7}, {6, 0.8}});
  EXPECT_DOUBLE_EQ(*bites().bites_proximal, 2.0 / 4);  // staying is not going on
  EXPECT_DOUBLE_EQ(*bites().sets_proximal, 1.0 / 2);
  std::reverse(sutures.begin(), sutures.end());
  EXPECT_DOUBLE_EQ(*bites().sets_proximal, 1.0 / 2);
  sutures.erase(sutures.begin());
  EXPECT_DOUBLE_EQ(*bites().sets_proximal, 0);
}

TEST_F(SutureSkill, aSetThatLostAllBitesHasNoPlaceInTheOrder) {
  add({{0, 0.9}, {1, 0.8}});
  add({}).tear_outs = 3;
  add({{3, 0.6}, {4, 0.5}});
  EXPECT_DOUBLE_EQ(*bites().sets_proximal, 1);
  EXPECT_EQ(bites().taken, 7);
  EXPECT_EQ(bites().torn_out, 3);
  EXPECT_EQ(sets()[1].torn_out, 3);
  EXPECT_FALSE(sets()[1].along.has_value());
}

TEST_F(SutureSkill, countsWallsAndWhatIsOffTheBody) {
  Suture& suture = add({{0, 0.9}, {1, 0.8}, {2, 0.7}, {3, 0.6}, {4, 0.5}});
  const Region regions[] = {Region::Pylorus, Region::Antrum, Region::Body, Region::Fundus, Region::Cardia};
  for (int k = 0; k < 5; ++k) suture.bites[k].region = regions[k];
  suture.bites[2].wall = Wall::Posterior;
  EXPECT_EQ(bites().in_antrum, 2);
  EXPECT_EQ(bites().in_fundus, 2);
  EXPECT_EQ(bites().wall, (std::array<int, kWallCount>{4, 0, 1, 0}));
}

TEST_F(SutureSkill, aSetIsNamedByItsTTagAndMeasuredByItsCinch) {
  Suture& suture = add({{0, 0.9}, {1, 0.8}, {2, 0.7}, {3, 0.6}});
  suture.begin = 10;
  suture.technique = static_cast<std::uint8_t>(Technique::Z);
  suture.technique_margin = 0.75;
  EXPECT_FALSE(sets()[0].named || sets()[0].loose || sets()[0].cinch_tension || sets()[0].duration);
  suture.stage = Suture::Stage::Tagged;
  EXPECT_TRUE(sets()[0].named);
  EXPECT_EQ(sets()[0].technique, Technique::Z);
  EXPECT_EQ(sets()[0].margin, 0.75);
  suture.stage = Suture::Stage::Cinched;
  suture.end = 40;
  suture.pulled = 0.02;
  suture.tension = {1, 3, 2};
  suture.cinch_tension = scene.loose_tension;
  EXPECT_FALSE(sets()[0].loose);
  EXPECT_DOUBLE_EQ(*sets()[0].duration, 30);
  EXPECT_DOUBLE_EQ(*sets()[0].thread, 0.036);
  EXPECT_DOUBLE_EQ(sets()[0].tension, 3);
  suture.cinch_tension = 0.99 * scene.loose_tension;
  EXPECT_TRUE(sets()[0].loose);
  EXPECT_DOUBLE_EQ(*sets()[0].cinch_tension, suture.cinch_tension);
}

TEST_F(SutureSkill, followsThreadsFromStepToStep) {
  Suture& suture = add({{0, 0.9}, {1, 0.8}});
  std::vector<SetSkill> known = sets();
  suture.length = {0.004};
  suture.tension = {2.5};
  suture.pulled = 0.008;
  updateSets(sutures, known);
  EXPECT_DOUBLE_EQ(*known[0].thread, 0.004);
  EXPECT_DOUBLE_EQ(known[0].tension, 2.5);
  EXPECT_DOUBLE_EQ(known[0].drawn, 0.008);
}

}  // namespace
}  // namespace vibe::skill_sutures_test
