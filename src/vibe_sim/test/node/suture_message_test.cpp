#include "conversions/suture_message.hpp"

#include <gtest/gtest.h>

#include <functional>

#include "conversions/conversions.hpp"
#include "vibe_testing/worlds.hpp"

namespace vibe::sim::suture_message_test {
namespace {

using test::World;
using Wire = vibe_msgs::Suture;

Bite biteAt(int particle) {
  Bite bite;
  bite.particle = {particle};
  bite.weight = {1};
  bite.depth = 3e-3;
  bite.thickness = 2e-3;
  bite.region = Region::Body;
  bite.wall = Wall::GreaterCurvature;
  bite.along = 0.5;
  bite.time = 4;
  return bite;
}

/// A balloon with three bites on particles 0, 1 and 2, which stand at known places, and gravity along -z.
class SutureMessage : public ::testing::Test {
 protected:
  World world = makeWorld();
  Suture* suture = nullptr;

  SutureMessage() {
    place(0, {0, 0, 0});
    place(1, {0.03, 0, 0});
    place(2, {0.03, 0.04, 0});
    world.state.procedure.sutures.resize(1);
    suture = &world.state.procedure.sutures[0];
    suture->bites = {biteAt(0), biteAt(1), biteAt(2)};
    suture->length = {0.03, 0.04};
    suture->tension = {0, 0};
  }

  static World makeWorld() {
    Scene scene = test::bareScene();
    scene.gravity.emplace();
    scene.gravity->acceleration = {0, 0, -9.81};
    return World(scene, test::plainOrgan(test::icosphere(0.05, 1), 2e-3));
  }

  void place(int i, const Eigen::Vector3d& p) {
    world.state.x[i] = p.x();
    world.state.y[i] = p.y();
    world.state.z[i] = p.z();
  }

  vibe_msgs::SutureArray message() const { return makeSutures(*world.model, world.state, 1'500'000'000); }
  Wire first() const { return message().sutures.at(0); }
};

double lengthOf(const Wire& suture, std::size_t piece) {
  double length = 0;
  for (std::uint32_t k = suture.thread_offsets[piece]; k < suture.thread_offsets[piece + 1]; ++k) {
    const auto &a = suture.thread[k], &b = suture.thread[k + 1];
    length += Eigen::Vector3d(b.x - a.x, b.y - a.y, b.z - a.z).norm();
  }
  return length;
}

TEST(SutureMessages, ofAnUntouchedOrganAreEmpty) {
  const World world(test::bareScene(), test::plainOrgan(test::icosphere(0.05, 1), 2e-3));
  const vibe_msgs::SutureArray message = makeSutures(*world.model, world.state, 1'500'000'000);
  EXPECT_EQ(message.header.frame_id, "world");
  EXPECT_EQ(message.header.stamp.toSec(), 1.5);
  EXPECT_TRUE(message.sutures.empty() && message.bleedings.empty());
  EXPECT_EQ(message.blood_lost, 0);
}

TEST_F(SutureMessage, bitesKeepTheirContentAndMoveWithTheWall) {
  suture->bites[1].particle = {1, 2};
  suture->bites[1].weight = {0.25, 0.75};
  suture->bites[2].depth = 1e-3;
  const Wire s = first();
  ASSERT_EQ(s.bites.size(), 3u);
  EXPECT_DOUBLE_EQ(s.bites[1].position.x, 0.03);
  EXPECT_DOUBLE_EQ(s.bites[1].position.y, 0.03);  // weighted mean of 0 and 0.04
  EXPECT_EQ(s.bites[1].particle, 2);
  EXPECT_EQ(s.bites[0].depth, 3e-3);
  EXPECT_EQ(s.bites[0].thickness, 2e-3);
  EXPECT_EQ(s.bites[0].time, 4);
  EXPECT_EQ(s.bites[0].along, 0.5);
  EXPECT_EQ(s.bites[0].region, vibe_msgs::TissueTopology::REGION_BODY);
  EXPECT_EQ(s.bites[0].wall, vibe_msgs::TissueTopology::WALL_GREATER_CURVATURE);
  EXPECT_TRUE(s.bites[0].full_thickness);
  EXPECT_FALSE(s.bites[2].full_thickness);
}

TEST_F(SutureMessage, aTautThreadIsStraightFromBiteToBite) {
  suture->tension = {2.5, 1.5};
  suture->length = {0.029, 0.039};
  const Wire s = first();
  ASSERT_EQ(s.thread.size(), 3u);
  EXPECT_EQ(s.thread_offsets, (std::vector<std::uint32_t>{0, 1, 2}));
  EXPECT_EQ(s.thread[2].y, 0.04);
  EXPECT_EQ(s.tension, (std::vector<double>{2.5, 1.5}));
  EXPECT_EQ(s.length, (std::vector<double>{0.029, 0.039}));
}

TEST_F(SutureMessage, aSlackThreadHangsWithItsLengthAndThroughItsBites) {
  suture->length = {0.05, 0.04};
  const Wire s = first();
  ASSERT_EQ(s.thread_offsets.size(), 3u);
  EXPECT_GT(s.thread_offsets[1], 4u);
  EXPECT_EQ(s.thread_offsets[2], s.thread_offsets[1] + 1);  // as long as the distance: straight
  EXPECT_NEAR(lengthOf(s, 0), 0.05, 0.01 * 0.05);
  EXPECT_LT(lengthOf(s, 0), 0.05);  // a drawn arc is shorter than the arc
  EXPECT_NEAR(lengthOf(s, 1), 0.04, 1e-12);
  EXPECT_EQ(s.thread[s.thread_offsets[1]].x, 0.03);
  const auto& middle = s.thread[s.thread_offsets[1] / 2];
  EXPECT_LT(middle.z, -0.01);  // it hangs down
  EXPECT_NEAR(middle.x, 0.015, 1e-9);
}

TEST_F(SutureMessage, placesThatAreNoNumbersDrawAStraightThread) {
  suture->length = {0.05, 0.04};
  place(0, {std::nan(""), 0, 0});
  EXPECT_EQ(first().thread.size(), 3u);
}

TEST_F(SutureMessage, aBrokenOrShortThreadIsNotDrawn) {
  suture->stage = Suture::Stage::Broken;
  EXPECT_TRUE(first().thread.empty() && first().thread_offsets.empty());
  suture->stage = Suture::Stage::Open;
  suture->bites.resize(1);
  suture->length.clear();
  suture->tension.clear();
  EXPECT_TRUE(first().thread.empty());
  EXPECT_EQ(first().bites.size(), 1u);
}

TEST_F(SutureMessage, tTagAndCinchSitAtTheEndsOnceTheyAreThere) {
  EXPECT_FALSE(first().has_t_tag || first().has_cinch);
  EXPECT_EQ(first().technique_name, "");
  EXPECT_EQ(first().printed_technique_name, "");
  suture->stage = Suture::Stage::Tagged;
  EXPECT_TRUE(first().has_t_tag);
  EXPECT_FALSE(first().has_cinch);
  EXPECT_EQ(first().t_tag.y, 0.04);
  suture->stage = Suture::Stage::Cinching;
  EXPECT_TRUE(first().has_cinch);
  EXPECT_EQ(first().cinch.x, 0);
  suture->bites.clear();
  suture->stage = Suture::Stage::Broken;
  EXPECT_FALSE(first().has_t_tag || first().has_cinch);
}

TEST_F(SutureMessage, tellsTechniqueCinchAndTears) {
  suture->stage = Suture::Stage::Cinched;
  suture->technique = 2;
  suture->corrected_technique = 2;
  suture->printed_technique = 1;
  suture->technique_margin = 0.4;
  suture->transitions = {1, 2};
  suture->taken = {{1, 2, 3}};
  suture->pulled = 0.05;
  suture->cinch_tension = 0.4;
  suture->begin = 1;
  suture->end = 9;
  suture->tear_outs = 2;
  const Wire s = first();
  EXPECT_EQ(s.stage, Wire::CINCHED);
  EXPECT_EQ(s.technique, Wire::TECHNIQUE_Z);
  EXPECT_EQ(s.technique_name, "z");
  EXPECT_EQ(s.corrected_technique, Wire::TECHNIQUE_Z);
  EXPECT_EQ(s.corrected_technique_name, "z");
  EXPECT_EQ(s.printed_technique, Wire::TECHNIQUE_U);
  EXPECT_EQ(s.printed_technique_name, "u");
  EXPECT_EQ(s.technique_margin, 0.4);
  EXPECT_EQ(s.transitions[0], 1);
  EXPECT_EQ(s.transitions[1], 2);
  EXPECT_EQ(s.taken.at(0).z, 3);
  EXPECT_EQ(s.pulled, 0.05);
  EXPECT_EQ(s.cinch_tension, 0.4);
  EXPECT_EQ(s.begin, 1);
  EXPECT_EQ(s.end, 9);
  EXPECT_EQ(s.tear_outs, 2u);
  EXPECT_FALSE(s.loose) << "the scene does not say what is loose";
}

TEST_F(SutureMessage, tellsWhatBleedsWhere) {
  world.state.procedure.bleedings = {{0, 1, 1, true, 4.5, 2.5e-7, 1e-6, true}, {0, -1, -1, false, 1, 0, 2e-6, false}};
  world.state.procedure.blood_lost = 3e-6;
  const vibe_msgs::SutureArray m = message();
  ASSERT_EQ(m.bleedings.size(), 2u);
  EXPECT_EQ(m.bleedings[0].bite, 1);
  EXPECT_EQ(m.bleedings[0].position.x, 0.03);
  EXPECT_TRUE(m.bleedings[0].brisk && m.bleedings[0].overdue);
  EXPECT_EQ(m.bleedings[0].rate, 2.5e-7);
  EXPECT_EQ(m.bleedings[0].amount, 1e-6);
  EXPECT_EQ(m.bleedings[0].begin, 4.5);
  EXPECT_EQ(m.bleedings[1].position.x, 0);
  EXPECT_EQ(m.blood_lost, 3e-6);
}

TEST_F(SutureMessage, kindChangesWithWhatIsToldAtOnceAndWithNothingElse) {
  ProcedureState& p = world.state.procedure;
  p.bleedings.resize(1);
  p.bleedings[0].rate = 1e-8;
  const std::uint64_t before = kindOf(p);
  const std::vector<std::function<void(ProcedureState&)>> told = {
      [](ProcedureState& s) { s.sutures[0].stage = Suture::Stage::Tagged; },
      [](ProcedureState& s) { s.sutures[0].bites.pop_back(); },
      [](ProcedureState& s) { s.sutures[0].technique = 1; },
      [](ProcedureState& s) { s.sutures[0].tear_outs = 1; },
      [](ProcedureState& s) { s.sutures.emplace_back(); },
      [](ProcedureState& s) { s.bleedings.emplace_back(); },
      [](ProcedureState& s) { s.bleedings[0].rate = 0; },
      [](ProcedureState& s) { s.bleedings[0].overdue = true; },
  };
  for (std::size_t k = 0; k < told.size(); ++k) {
    ProcedureState changed = p;
    told[k](changed);
    EXPECT_NE(kindOf(changed), before) << k;
  }
  p.sutures[0].tension[0] = 3;
  p.bleedings[0].amount = 1;
  p.blood_lost = 1;
  EXPECT_EQ(kindOf(p), before);
}

}  // namespace
}  // namespace vibe::sim::suture_message_test
