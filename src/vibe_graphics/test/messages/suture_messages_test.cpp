#include "vibe_graphics/messages/suture_messages.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <random>

#include "suture_sessions.hpp"

namespace vibe::graphics::suture_messages_test {
namespace {

using vibe_msgs::SutureArray;
using Links = std::vector<std::pair<std::size_t, std::size_t>>;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

SutureDrawing sceneOf(const SutureArray& message) {
  SutureDrawing scene;
  EXPECT_EQ(readSutures(message, scene), "");
  return scene;
}

TEST(SutureMessages, ReadsAWholeSession) {
  const SutureDrawing scene = sceneOf(session());
  ASSERT_EQ(scene.sets.size(), 2u);
  const SutureSet& set = scene.sets[0];
  EXPECT_EQ(set.stage, SutureStage::Cinched);
  ASSERT_EQ(set.bites.size(), 6u);
  EXPECT_TRUE(set.bites[0].full_thickness);
  EXPECT_FALSE(set.bites[1].full_thickness);
  ASSERT_EQ(set.pieces.size(), 5u);
  EXPECT_EQ(set.pieces[0].line.size(), 3u);
  EXPECT_EQ(set.pieces[1].line.size(), 2u);
  EXPECT_EQ(set.pieces[0].line.back(), set.bites[1].place);
  EXPECT_EQ(set.pieces[4].tension, 2);
  EXPECT_TRUE(set.has_t_tag && set.has_cinch);
  EXPECT_EQ(set.t_tag, set.bites[5].place);
  EXPECT_EQ(set.cinch, set.bites[0].place);
  EXPECT_TRUE(scene.sets[1].pieces.empty());
}

TEST(SutureMessages, ReadsBleeding) {
  const SutureDrawing scene = sceneOf(session());
  ASSERT_EQ(scene.wounds.size(), 3u);
  EXPECT_FALSE(scene.wounds[0].brisk);
  EXPECT_TRUE(scene.wounds[1].brisk);
  EXPECT_EQ(scene.wounds[0].age, 15);
  EXPECT_EQ(scene.wounds[0].inward, Eigen::Vector3d::UnitX());  // the posterior wall looks to the front
  EXPECT_EQ(scene.wounds[2].inward, Eigen::Vector3d::Zero());   // the bite is gone
}

TEST(SutureMessages, EmptySessionIsValid) {
  SutureDrawing scene = sceneOf(session());
  EXPECT_EQ(readSutures({}, scene), "");
  EXPECT_TRUE(scene.sets.empty() && scene.wounds.empty());
}

TEST(SutureMessages, CornersAreTheBitesAfterTheTransitions) {
  EXPECT_EQ(sceneOf(session()).sets[0].corners, (std::vector<std::size_t>{2, 3}));
}

TEST(SutureMessages, LinksFollowTheTechnique) {
  SutureArray message = session();
  EXPECT_EQ(sceneOf(message).sets[0].links, (Links{{0, 2}, {3, 5}}));  // the legs
  message.sutures[0].technique = vibe_msgs::Suture::TECHNIQUE_Z;
  EXPECT_EQ(sceneOf(message).sets[0].links, (Links{{0, 3}, {2, 5}}));
  message.sutures[0].technique = vibe_msgs::Suture::TECHNIQUE_RUNNING;
  message.sutures[0].transitions = {-1, -1};
  EXPECT_EQ(sceneOf(message).sets[0].links, (Links{{0, 1}, {1, 2}, {2, 3}, {3, 4}, {4, 5}}));
  message.sutures[0].technique = vibe_msgs::Suture::TECHNIQUE_OTHER;
  EXPECT_TRUE(sceneOf(message).sets[0].links.empty());
}

/// Numbers of bites are those of when the T-tag was dropped.
TEST(SutureMessages, AfterATearOutThereAreNoCornersAndLinks) {
  SutureArray message = session();
  message.sutures[0].taken.push_back(pointOf(0, 0, 0));
  const SutureDrawing scene = sceneOf(message);
  EXPECT_TRUE(scene.sets[0].corners.empty());
  EXPECT_TRUE(scene.sets[0].links.empty());
  EXPECT_EQ(scene.sets[0].technique, "u");
}

struct Fault {
  const char* named;  // by the sentence
  std::function<void(SutureArray&)> make;
};

const std::vector<Fault>& faults() {
  static const std::vector<Fault> list{
      {"position of bite 2", [](SutureArray& m) { m.sutures[0].bites[2].position.y = kNan; }},
      {"position of bite 0 of suture 1", [](SutureArray& m) { m.sutures[1].bites[0].position.x = 1e9; }},
      {"Point 3 of thread", [](SutureArray& m) { m.sutures[0].thread[3].z = kNan; }},
      {"t_tag", [](SutureArray& m) { m.sutures[0].t_tag.x = INFINITY; }},
      {"cinch", [](SutureArray& m) { m.sutures[0].cinch.x = kNan; }},
      {"thread_offsets", [](SutureArray& m) { m.sutures[0].thread_offsets.pop_back(); }},
      {"thread_offsets", [](SutureArray& m) { m.sutures[0].thread_offsets[5] = 7; }},
      {"thread_offsets", [](SutureArray& m) { m.sutures[0].thread_offsets[5] = 4'000'000'000u; }},
      {"thread_offsets",
       [](SutureArray& m) { std::swap(m.sutures[0].thread_offsets[2], m.sutures[0].thread_offsets[3]); }},
      {"thread_offsets", [](SutureArray& m) { m.sutures[0].thread_offsets[0] = 1; }},
      {"thread_offsets", [](SutureArray& m) { m.sutures[0].bites.clear(), m.bleedings.clear(); }},
      {"Only one of thread and thread_offsets of suture 0 is empty",
       [](SutureArray& m) { m.sutures[0].thread.clear(); }},
      {"Only one of thread and thread_offsets of suture 0 is empty",
       [](SutureArray& m) { m.sutures[0].thread_offsets.clear(); }},
      {"tension and length", [](SutureArray& m) { m.sutures[0].tension.pop_back(); }},
      {"tension and length", [](SutureArray& m) { m.sutures[0].length.push_back(1); }},
      {"A tension", [](SutureArray& m) { m.sutures[0].tension[1] = kNan; }},
      {"A tension", [](SutureArray& m) { m.sutures[0].tension[1] = -1; }},
      {"stage", [](SutureArray& m) { m.sutures[0].stage = 5; }},
      {"technique", [](SutureArray& m) { m.sutures[0].technique = 7; }},
      {"technique_margin", [](SutureArray& m) { m.sutures[0].technique_margin = kNan; }},
      {"technique_margin", [](SutureArray& m) { m.sutures[0].technique_margin = 1.5; }},
      {"transitions", [](SutureArray& m) { m.sutures[0].transitions[1] = 4; }},
      {"transitions", [](SutureArray& m) { m.sutures[0].transitions[0] = -2; }},
      {"transitions", [](SutureArray& m) { m.sutures[0].taken.clear(); }},
      {"position of bleeding 0", [](SutureArray& m) { m.bleedings[0].position.x = kNan; }},
      {"rate, amount or begin of bleeding 1", [](SutureArray& m) { m.bleedings[1].rate = -1; }},
      {"rate, amount or begin of bleeding 1", [](SutureArray& m) { m.bleedings[1].amount = kNan; }},
      {"rate, amount or begin of bleeding 1", [](SutureArray& m) { m.bleedings[1].begin = kNan; }},
      {"suture of bleeding 1", [](SutureArray& m) { m.bleedings[1].suture = 2; }},
      {"suture of bleeding 1", [](SutureArray& m) { m.bleedings[1].suture = -1; }},
      {"bite of bleeding 1", [](SutureArray& m) { m.bleedings[1].bite = 1; }},
      {"bite of bleeding 1", [](SutureArray& m) { m.bleedings[1].bite = -2; }},
      {"ten thousand", [](SutureArray& m) { m.bleedings.resize(10'001); }},
  };
  return list;
}

TEST(SutureMessages, EveryFaultIsReportedInOneSentence) {
  for (const Fault& fault : faults()) {
    SutureArray message = session();
    fault.make(message);
    SutureDrawing scene;
    const std::string said = readSutures(message, scene);
    EXPECT_NE(said.find(fault.named), std::string::npos) << "'" << fault.named << "' is not in: " << said;
    EXPECT_EQ(said.empty() ? '\0' : said.back(), '.');
    EXPECT_TRUE(scene.sets.empty()) << fault.named;
  }
}

TEST(SutureMessages, FaultLeavesTheLastValidScene) {
  SutureDrawing scene = sceneOf(session());
  SutureArray message = session();
  message.sutures.resize(1);
  message.bleedings[0].position.x = kNan;
  EXPECT_NE(readSutures(message, scene), "");
  EXPECT_EQ(scene.sets.size(), 2u);
}

// What a simulator really sends must not be refused.
TEST(SutureMessages, UsualStatesAreValid) {
  const std::vector<std::function<void(SutureArray&)>> usual{
      [](SutureArray& m) { m.sutures[1] = vibe_msgs::Suture(), m.bleedings.clear(); },
      [](SutureArray& m) {
        m.sutures[1].transitions = {-1, -1};
      },
      [](SutureArray& m) {
        m.sutures[0].stage = vibe_msgs::Suture::BROKEN, m.sutures[0].thread.clear(),
        m.sutures[0].thread_offsets.clear();
      },
      [](SutureArray& m) {
        m.sutures[0].bites.pop_back(), m.sutures[0].thread.pop_back(), m.sutures[0].tension.pop_back(),
            m.sutures[0].length.pop_back(), m.sutures[0].thread_offsets.pop_back();
      },
      [](SutureArray& m) { m.bleedings[0].rate = 0; },
      [](SutureArray& m) { m.bleedings[0].begin = 1e9; }};
  for (std::size_t k = 0; k < usual.size(); ++k) {
    SutureArray message = session();
    usual[k](message);
    SutureDrawing scene;
    EXPECT_EQ(readSutures(message, scene), "") << "state " << k;
  }
}

using Spoil = std::function<void(SutureArray&, vibe_msgs::Suture&, std::mt19937&)>;

std::uint32_t anyNumber(std::mt19937& random) {
  return static_cast<std::uint32_t>(random());
}

double anyValue(std::mt19937& random) {
  const double values[] = {kNan, -1, 0, 1e300, -1e300, 7};
  return values[random() % 6];
}

const std::vector<Spoil>& spoils() {
  using Suture = vibe_msgs::Suture;
  static const std::vector<Spoil> list{
      [](SutureArray&, Suture& s, std::mt19937& r) { s.bites.resize(r() % 9); },
      [](SutureArray&, Suture& s, std::mt19937& r) { s.thread.resize(r() % 9); },
      [](SutureArray&, Suture& s, std::mt19937& r) { s.thread_offsets.resize(r() % 9); },
      [](SutureArray&, Suture& s, std::mt19937& r) { s.thread_offsets.assign(s.bites.size(), anyNumber(r)); },
      [](SutureArray&, Suture& s, std::mt19937& r) { s.tension.assign(r() % 9, anyValue(r)); },
      [](SutureArray&, Suture& s, std::mt19937& r) { s.transitions[r() % 2] = static_cast<int>(anyNumber(r)); },
      [](SutureArray&, Suture& s, std::mt19937& r) { s.taken.resize(r() % 9); },
      [](SutureArray& m, Suture&, std::mt19937& r) { m.bleedings[r() % 3].suture = static_cast<int>(anyNumber(r)); },
      [](SutureArray& m, Suture&, std::mt19937& r) { m.bleedings[r() % 3].bite = static_cast<int>(anyNumber(r)); },
      [](SutureArray& m, Suture&, std::mt19937& r) { m.bleedings[r() % 3].amount = anyValue(r); }};
  return list;
}

/// Two faults at once, any numbers: an answer, no crash (under the sanitizers too).
TEST(SutureMessages, RandomNumbersDoNotCrash) {
  std::mt19937 random(4);
  for (int round = 0; round < 4000; ++round) {
    SutureArray message = session();
    vibe_msgs::Suture& suture = message.sutures[random() % 2];
    for (int k = 0; k < 2; ++k) spoils()[random() % spoils().size()](message, suture, random);
    SutureDrawing scene;
    if (!readSutures(message, scene).empty()) continue;
    for (const SutureSet& set : scene.sets)
      for (const std::size_t corner : set.corners) ASSERT_LT(corner, set.bites.size());
  }
}

}  // namespace
}  // namespace vibe::graphics::suture_messages_test
