#include "conversions/procedure_message.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "vibe_testing/worlds.hpp"

namespace vibe::sim::procedure_message_test {
namespace {

class ProcedureMessage : public ::testing::Test {
 protected:
  TimedSimulation simulation = makeSimulation();
  State& state = simulation.editState();
  ProcedureState& procedure = state.procedure;

  static TimedSimulation makeSimulation() {
    Scene scene = test::bareScene();
    scene.suture.emplace();
    const test::World world(scene, test::plainOrgan(test::icosphere(0.05, 1), 2e-3));
    return TimedSimulation({world.model, ""}, 1, 1'000'000'000, 1);
  }

  /// A step that leads to the present state, with these events.
  void record(std::initializer_list<Event::Kind> kinds = {}) {
    std::vector<Event> events;
    for (Event::Kind kind : kinds) events.emplace_back().kind = kind;
    simulation.record(events);
  }

  vibe_msgs::ProcedureState message() const { return makeProcedureState(simulation, {}); }
  vibe_msgs::SkillMetrics skill() const { return makeSkillMetrics(simulation); }
  std::string kind() const { return kindOf(simulation, {}); }

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
  EXPECT_EQ(m.tool_state, "free");
  EXPECT_EQ(m.phase, "inspect");
  EXPECT_TRUE(m.needle_loaded && m.needle_on_arm);
  EXPECT_EQ(m.marks + m.burns + m.bites + m.sutures + m.tear_outs + m.bleeding, 0u);
  EXPECT_TRUE(m.techniques.empty());
}

TEST_F(ProcedureMessage, countsParticlesByGradeWithTheWorseOnesIncluded) {
  procedure.grade = {0, 1, 1, 2, 3, 0};
  procedure.beam_energy = 60;
  procedure.phase = Phase::Mark;
  const vibe_msgs::ProcedureState m = message();
  EXPECT_EQ(m.phase, "mark");
  EXPECT_EQ(m.marks, 4u);
  EXPECT_EQ(m.burns, 2u);
  EXPECT_EQ(m.deep_burns, 1u);
  EXPECT_EQ(m.beam_energy, 60);
}

TEST_F(ProcedureMessage, countsSuturesByWhatBecameOfThem) {
  const double loose = simulation.model().scene.suture->loose_tension;
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
  record({Kind::BiteMissed, Kind::BiteMissed, Kind::BiteWithdrawn, Kind::Rejected, Kind::Rejected, Kind::Rejected});
  record({Kind::BleedingOverdue});
  EXPECT_EQ(skill().missed_bites, 2u);
  EXPECT_EQ(skill().withdrawn_bites, 1u);
  EXPECT_EQ(skill().rejected, 3u);
  EXPECT_EQ(skill().overdue_bleedings, 1u);
  simulation.replaceState(state);
  EXPECT_EQ(skill().rejected + skill().missed_bites, 0u);
}

TEST_F(ProcedureMessage, sessionMeasuresAndStateHaveTheSameTime) {
  state.time = 2.5;
  state.step = 150;
  state.contact_count = 1;
  state.tool_force = Eigen::Vector3d(3, 0, 4);
  state.volume = 1e-3;
  record({Event::Kind::Grab, Event::Kind::Release, Event::Kind::Slip, Event::Kind::GrabMissed, Event::Kind::Recovery});
  EXPECT_EQ(skill().time, 2.5);
  EXPECT_EQ(message().time, 2.5);
  EXPECT_EQ(skill().header.stamp, message().header.stamp);
  EXPECT_NEAR(skill().contact_time, simulation.model().scene.step_period, 1e-12);
  EXPECT_EQ(skill().grip_time + skill().insufflation_time + skill().path_length, 0);
  EXPECT_DOUBLE_EQ(skill().max_force, 5);
  EXPECT_DOUBLE_EQ(skill().mean_force, 5);
  EXPECT_EQ(skill().max_volume, 1e-3);
  EXPECT_EQ(message().volume, 1e-3);
  const vibe_msgs::SkillMetrics m = skill();
  EXPECT_EQ(std::vector<std::uint32_t>({m.grabs, m.missed_grabs, m.releases, m.slips, m.warnings}),
            std::vector<std::uint32_t>(5, 1));
}

TEST_F(ProcedureMessage, whatIsNotDefinedYetIsNan) {
  const vibe_msgs::SkillMetrics m = skill();
  for (double value : {m.economy,
                       m.log_dimensionless_jerk,
                       m.spectral_arc_length,
                       m.bite_spacing_mean,
                       m.bite_spacing_sd,
                       m.bite_depth_mean,
                       m.bite_depth_sd,
                       m.full_thickness_share,
                       m.bites_proximal,
                       m.sets_proximal,
                       m.lumen_area,
                       m.organ_length,
                       m.area_reduction,
                       m.length_reduction,
                       m.phase_economy[0],
                       m.phase_max_force[4],
                       m.phase_mean_force[2],
                       m.coverage,
                       m.coverage_region[1],
                       m.coverage_wall[3],
                       m.phase_log_dimensionless_jerk[1],
                       m.phase_spectral_arc_length[3]})
    EXPECT_TRUE(std::isnan(value));
  EXPECT_EQ(m.phase_time[0] + m.time_above + m.volume_reduction, 0);
  EXPECT_EQ(m.mark_zones + m.mild_bleedings + m.broken_threads + m.submovements, 0u);
  EXPECT_EQ(m.organ_reference, "rest");
}

TEST_F(ProcedureMessage, timesAndForcesStandAtTheirPhase) {
  const double dt = simulation.model().scene.step_period;
  state.tool_force = Eigen::Vector3d(0, 6, 0);
  record();
  procedure.phase = Phase::Pull;
  state.tool_force = Eigen::Vector3d(0, 0, 2);
  record();
  record();
  const vibe_msgs::SkillMetrics m = skill();
  EXPECT_NEAR(m.phase_time[0], dt, 1e-12);
  EXPECT_NEAR(m.phase_time[3], 2 * dt, 1e-12);
  EXPECT_EQ(m.phase_time[2], 0);
  EXPECT_EQ(m.phase_max_force[0], 6);
  EXPECT_EQ(m.phase_mean_force[3], 2);
  EXPECT_NEAR(m.phase_time_above[0], dt, 1e-12);
  EXPECT_EQ(m.phase_time_above[3], 0);
  EXPECT_NEAR(m.time_above, dt, 1e-12);
}

TEST_F(ProcedureMessage, tellsHowBitesLie) {
  Suture& suture = addSuture(Suture::Stage::Tagged, 3, 1);
  suture.technique = 1;
  suture.technique_margin = 0.5;
  for (int k = 0; k < 4; ++k) {
    suture.bites[k].particle = {k};
    suture.bites[k].weight = {1};
    suture.bites[k].along = k == 3 ? 0.8 : 0.7 - 0.1 * k;
  }
  suture.bites[0].region = Region::Antrum;
  suture.bites[1].region = suture.bites[2].region = Region::Fundus;
  record({Event::Kind::Bite});
  const vibe_msgs::SkillMetrics m = skill();
  EXPECT_DOUBLE_EQ(m.full_thickness_share, 0.75);
  EXPECT_DOUBLE_EQ(m.bite_depth_mean, 2.5e-3);
  EXPECT_DOUBLE_EQ(m.bite_depth_sd, 1e-3);
  const auto& vertices = simulation.model().organ.surface.vertices;
  Eigen::Vector3d spacing;  // bite k is at vertex k
  for (int k = 0; k < 3; ++k) spacing[k] = (vertices[k + 1] - vertices[k]).norm();
  EXPECT_NEAR(m.bite_spacing_mean, spacing.mean(), 1e-12);
  EXPECT_NEAR(m.bite_spacing_sd, std::sqrt((spacing.array() - spacing.mean()).square().sum() / 2), 1e-12);
  EXPECT_DOUBLE_EQ(m.bites_proximal, 2.0 / 3);
  EXPECT_TRUE(std::isnan(m.sets_proximal));
  EXPECT_EQ(m.bites_in_antrum, 1u);
  EXPECT_EQ(m.bites_in_fundus, 2u);
  EXPECT_EQ(message().technique_margins, std::vector<double>{0.5});
}

TEST_F(ProcedureMessage, tellsMarksBleedingsAndTheOrgan) {
  procedure.grade.assign(state.x.size(), 0);
  procedure.grade[0] = 3;
  procedure.bleedings.resize(3);
  procedure.bleedings[1].brisk = true;
  for (auto* coordinate : {&state.x, &state.y, &state.z})
    for (double& value : *coordinate) value *= 0.5;
  state.pressure = 1000;
  record({Event::Kind::PressureReached, Event::Kind::DeepBurn, Event::Kind::ThreadBroke, Event::Kind::ThreadBroke});
  for (int k = 0; k < std::ceil(0.1 / simulation.model().scene.step_period); ++k) record();  // marks are counted then
  const vibe_msgs::SkillMetrics m = skill();
  EXPECT_EQ(m.mark_zones, 1u);
  EXPECT_EQ(m.mark_zones_inside, 1u);
  EXPECT_EQ(m.mark_zones_anterior, 1u);
  EXPECT_EQ(m.mark_zones_greater_curvature + m.mark_zones_posterior, 0u);
  EXPECT_EQ(m.burn_zones, 1u);
  EXPECT_EQ(m.deep_burn_zones, 1u);
  EXPECT_EQ(m.mild_bleedings, 2u);
  EXPECT_EQ(m.brisk_bleedings, 1u);
  EXPECT_EQ(m.broken_threads, 2u);
  EXPECT_EQ(m.organ_reference, "set point");
  EXPECT_EQ(m.reference_pressure, 1000);
  EXPECT_EQ(m.organ_pressure, 1000);
  EXPECT_NEAR(m.volume_reduction, 0, 1e-12);
  for (double& value : state.x) value *= 0.5;
  for (int k = 0; k < std::lround(1 / simulation.model().scene.step_period); ++k) record();
  EXPECT_NEAR(skill().volume_reduction, 0.5, 1e-9);
}

TEST_F(ProcedureMessage, aNewStateBringsItsBitesAndNotWhatWasRecorded) {
  record({Event::Kind::ThreadBroke});
  State loaded = state;
  loaded.procedure.sutures.emplace_back().bites.resize(3);
  for (Bite& bite : loaded.procedure.sutures[0].bites) bite.depth = 4e-3;
  simulation.replaceState(loaded);
  EXPECT_EQ(skill().broken_threads, 0u);
  EXPECT_EQ(skill().phase_time[0], 0);
  EXPECT_DOUBLE_EQ(skill().bite_depth_mean, 4e-3);
  simulation.replaceModel({makeSimulation().sharedModel(), ""});
  EXPECT_TRUE(std::isnan(skill().bite_depth_mean));
  for (int k = 0; k < 100; ++k) record({Event::Kind::Mark});  // with the organ of the new model
  EXPECT_GT(skill().phase_time[0], 0);
}

TEST_F(ProcedureMessage, everyEventButContactIsToldAtOnce) {
  std::string before = kind();
  record({Event::Kind::ContactBegin, Event::Kind::ContactEnd});
  EXPECT_EQ(kind(), before);
  for (int k = 0; k <= static_cast<int>(Event::Kind::Blocked); ++k) {
    const auto event = static_cast<Event::Kind>(k);
    if (event == Event::Kind::ContactBegin || event == Event::Kind::ContactEnd) continue;
    record({event});
    EXPECT_NE(kind(), before) << toString(event);
    before = kind();
  }
}

}  // namespace
}  // namespace vibe::sim::procedure_message_test
