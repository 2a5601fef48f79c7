#include "procedure_message.hpp"

#include <gtest/gtest.h>

#include "worlds.hpp"

namespace vibe {
namespace {

class ProcedureMessage : public ::testing::Test {
 protected:
  Session session = makeSession();
  ProcedureState& procedure = session.state.procedure;

  static Session makeSession() {
    Scene scene = test::bareScene();
    scene.suture.emplace();
    const test::World world(scene, test::plainOrgan(test::icosphere(0.05, 1), 2e-3));
    return Session(world.model, 1, 1'000'000'000, 1);
  }

  void happen(std::initializer_list<Event::Kind> kinds) {
    std::vector<Event> events;
    for (Event::Kind kind : kinds) events.emplace_back().kind = kind;
    session.counts.record(events);
  }

  vibe_msgs::ProcedureState message() const { return makeProcedureState(session, {}); }
  std::string kind() const { return kindOf(session, {}); }

  Suture& addSuture(Suture::Stage stage, int full, int partial = 0) {
    Suture& suture = procedure.sutures.emplace_back();
    suture.stage = stage;
    suture.bites.resize(static_cast<std::size_t>(full + partial));
    for (int k = 0; k < full + partial; ++k) {
      suture.bites[k].thickness = 2e-3;
      suture.bites[k].depth = k < full ? 3e-3 : 1e-3;
    }
    return suture;
  }
};

TEST_F(ProcedureMessage, beginsWithALoadedNeedleAndNothingDone) {
  const vibe_msgs::ProcedureState m = message();
  EXPECT_EQ(m.phase, "free");
  EXPECT_EQ(m.procedure_phase, "inspect");
  EXPECT_TRUE(m.needle_loaded && m.needle_on_arm);
  EXPECT_EQ(m.marks + m.burns + m.bites + m.sutures + m.tear_outs + m.refused + m.bleeding, 0u);
  EXPECT_TRUE(m.techniques.empty());
}

TEST_F(ProcedureMessage, countsParticlesByGradeWithTheWorseOnesIncluded) {
  procedure.grade = {0, 1, 1, 2, 3, 0};
  procedure.beam_energy = 60;
  procedure.phase = Phase::Mark;
  const vibe_msgs::ProcedureState m = message();
  EXPECT_EQ(m.procedure_phase, "mark");
  EXPECT_EQ(m.marks, 4u);
  EXPECT_EQ(m.burns, 2u);
  EXPECT_EQ(m.deep_burns, 1u);
  EXPECT_EQ(m.beam_energy, 60);
}

TEST_F(ProcedureMessage, countsSuturesByWhatBecameOfThem) {
  const double loose = session.model->scene.suture->loose_tension;
  addSuture(Suture::Stage::Cinched, 6, 1).cinch_tension = loose;
  addSuture(Suture::Stage::Cinched, 4).cinch_tension = 0.99 * loose;
  procedure.sutures[1].technique = 1;
  addSuture(Suture::Stage::Broken, 1).tear_outs = 3;
  addSuture(Suture::Stage::Cinching, 2);
  addSuture(Suture::Stage::Open, 1, 1);
  const vibe_msgs::ProcedureState m = message();
  EXPECT_EQ(m.sutures, 5u);
  EXPECT_EQ(m.sutures_cinched, 1u);
  EXPECT_EQ(m.sutures_loose, 1u);
  EXPECT_EQ(m.sutures_broken, 1u);
  EXPECT_EQ(m.sutures_open, 2u);
  EXPECT_EQ(m.bites, 7u + 4u + 4u + 2u + 2u);
  EXPECT_EQ(m.partial_bites, 2u);
  EXPECT_EQ(m.tear_outs, 3u);
  EXPECT_EQ(m.techniques, (std::vector<std::string>{"other", "u", "other", "other"}));
}

TEST_F(ProcedureMessage, countsWhatBleedsNow) {
  procedure.bleedings.resize(3);
  procedure.bleedings[1].rate = 1e-8;
  procedure.blood_lost = 2e-6;
  EXPECT_EQ(message().bleeding, 1u);
  EXPECT_EQ(message().blood_lost, 2e-6);
}

TEST_F(ProcedureMessage, countsEventsAndForgetsThemWithTheState) {
  using Kind = Event::Kind;
  happen({Kind::BiteMissed, Kind::BiteMissed, Kind::BiteWithdrawn, Kind::Refused, Kind::Refused, Kind::Refused});
  happen({Kind::BleedingOverdue});
  EXPECT_EQ(message().missed_bites, 2u);
  EXPECT_EQ(message().withdrawn_bites, 1u);
  EXPECT_EQ(message().refused, 3u);
  EXPECT_EQ(message().overdue_bleedings, 1u);
  session.replaceState(session.state);
  EXPECT_EQ(message().refused + message().missed_bites, 0u);
}

TEST_F(ProcedureMessage, everyEventButContactIsToldAtOnce) {
  std::string before = kind();
  happen({Event::Kind::ContactBegin, Event::Kind::ContactEnd});
  EXPECT_EQ(kind(), before);
  for (int k = 0; k <= static_cast<int>(Event::Kind::ArmClosed); ++k) {
    const auto event = static_cast<Event::Kind>(k);
    if (event == Event::Kind::ContactBegin || event == Event::Kind::ContactEnd) continue;
    happen({event});
    EXPECT_NE(kind(), before) << toString(event);
    before = kind();
  }
}

}  // namespace
}  // namespace vibe
