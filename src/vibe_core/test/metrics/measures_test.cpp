#include "vibe_core/metrics/session_outcome.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <map>
#include <set>

#include "vibe_core/program/error.hpp"

namespace vibe::measures_test {
namespace {

using Kind = Event::Kind;

void count(SessionMetrics& m, Kind kind, int times) {
  std::vector<Event> events(static_cast<std::size_t>(times));
  for (Event& event : events) event.kind = kind;
  m.events.record(events);
}

PhaseSkill phase(double start) {
  PhaseSkill skill;
  skill.time = start;
  skill.motion.path_length = start + 1;
  skill.motion.log_dimensionless_jerk = start + 2;
  skill.motion.spectral_arc_length = start + 3;
  skill.motion.submovements = static_cast<int>(start) + 4;
  skill.motion.economy = start + 5;
  skill.motion.movements = static_cast<int>(start) + 6;
  skill.force.max = start + 7;
  skill.force.mean = start + 8;
  skill.force.time_above = start + 9;
  skill.force.share_above = start + 10;
  skill.force.loaded_time = 1;
  return skill;
}

void setSession(SessionMetrics& m) {
  m.time = 1;
  m.contact_time = 2;
  m.grip_time = 3;
  m.insufflation_time = 4;
  m.path_length = 5;
  m.max_force = 6;
  m.mean_force = 7;
  m.volume = 8;
  m.max_volume = 9;
  m.pressure = 10;
  m.max_pressure = 11;
  m.max_strain = 12;
  m.energy_balance = 13;
  m.relaxation_loss = 31;
  m.energy = {20, 0, 0, 21, 22, 23, 24, 25, 26, 27, 0, 28, 29, 30};
  m.skill.phases.whole = phase(100);
  for (int k = 0; k < kPhaseCount; ++k) m.skill.phases.phase[static_cast<std::size_t>(k)] = phase(200 + 100 * k);
}

void setCounts(SessionMetrics& m) {
  const Kind kinds[] = {Kind::Grab,          Kind::GrabMissed,  Kind::Release,         Kind::Slip,     Kind::BiteMissed,
                        Kind::BiteWithdrawn, Kind::ThreadBroke, Kind::BleedingOverdue, Kind::Rejected, Kind::Warning};
  int times = 1;
  for (const Kind kind : kinds) count(m, kind, times++);
  count(m, Kind::Recovery, 1);
}

void setProcedure(SkillMetrics& s) {
  s.marks.zones = 31;
  s.marks.inside = 32;
  s.marks.wall = {33, 34, 35, 0};
  s.marks.burns = 36;
  s.marks.deep_burns = 37;
  s.bites.taken = 41;
  s.bites.torn_out = 42;
  s.bites.full_thickness = 43;
  s.bites.spacing_mean = 44;
  s.bites.spacing_sd = 45;
  s.bites.depth_mean = 46;
  s.bites.depth_sd = 47;
  s.bites.full_thickness_share = 48;
  s.bites.in_antrum = 49;
  s.bites.in_fundus = 50;
  s.bites.bites_proximal = 51;
  s.bites.sets_proximal = 52;
  s.sets.resize(3);
  s.sets[0].cinch_tension = 2;
  s.sets[2].cinch_tension = 3;
  s.bleeding = {61, 62, 63, 64, 65};
}

void setOrgan(OrganSkill& o) {
  o.reference_pressure = 71;
  o.pressure = 72;
  o.now.emplace().mean_area = 73;
  o.now->length = 74;
  o.area_reduction = 75;
  o.volume_reduction = 76;
  o.length_reduction = 77;
}

SessionMetrics session() {
  SessionMetrics m;
  setSession(m);
  setCounts(m);
  setProcedure(m.skill);
  setOrgan(m.skill.organ);
  m.coverage = {0.5, {0.1, 0.2, 0.3, 0.4, 0.6}, {0.7, 0.8, 0.9, 1}};
  return m;
}

// Two sets: three bites in 60 s and two in 30 s; a single bite has no pace.
std::vector<Suture> sutures() {
  std::vector<Suture> result(3);
  for (const double time : {10.0, 30.0, 70.0}) result[0].bites.emplace_back().time = time;
  for (const double time : {100.0, 130.0}) result[1].bites.emplace_back().time = time;
  result[2].bites.emplace_back().time = 500;
  return result;
}

// Name, unit, value.
struct Row {
  const char* name;
  const char* unit;
  double value;
};

const std::vector<Row> kExpected = {{"time", "s", 1},
                                    {"contact_time", "s", 2},
                                    {"grip_time", "s", 3},
                                    {"insufflation_time", "s", 4},
                                    {"path_length", "m", 5},
                                    {"log_dimensionless_jerk", "1", 102},
                                    {"spectral_arc_length", "1", 103},
                                    {"movements", "1", 106},
                                    {"submovements", "1", 104},
                                    {"economy", "1", 105},
                                    {"max_force", "N", 6},
                                    {"mean_force", "N", 7},
                                    {"time_above", "s", 109},
                                    {"share_above", "1", 110},
                                    {"volume", "m^3", 8},
                                    {"max_volume", "m^3", 9},
                                    {"pressure", "Pa", 10},
                                    {"max_pressure", "Pa", 11},
                                    {"max_strain", "1", 12},
                                    {"tool_work", "J", 20},
                                    {"gas_work", "J", 21},
                                    {"thread_work", "J", 22},
                                    {"pull_work", "J", 23},
                                    {"friction_loss", "J", 24},
                                    {"damping_loss", "J", 25},
                                    {"viscous_loss", "J", 26},
                                    {"contact_loss", "J", 27},
                                    {"numerical_loss", "J", 28},
                                    {"relaxation_loss", "J", 31},
                                    {"correction_work", "J", 29},
                                    {"residual_work", "J", 30},
                                    {"energy_balance", "J", 13},
                                    {"phase_time.inspect", "s", 200},
                                    {"phase_path_length.mark", "m", 301},
                                    {"phase_log_dimensionless_jerk.suture", "1", 402},
                                    {"phase_spectral_arc_length.pull", "1", 503},
                                    {"phase_submovements.done", "1", 604},
                                    {"phase_economy.inspect", "1", 205},
                                    {"phase_max_force.mark", "N", 307},
                                    {"phase_mean_force.suture", "N", 408},
                                    {"phase_time_above.pull", "s", 509},
                                    {"grabs", "1", 1},
                                    {"missed_grabs", "1", 2},
                                    {"releases", "1", 3},
                                    {"slips", "1", 4},
                                    {"missed_bites", "1", 5},
                                    {"withdrawn_bites", "1", 6},
                                    {"broken_threads", "1", 7},
                                    {"overdue_bleedings", "1", 8},
                                    {"rejected", "1", 9},
                                    {"warnings", "1", 11},
                                    {"mark_zones", "1", 31},
                                    {"mark_zones_inside", "1", 32},
                                    {"mark_zones_anterior", "1", 33},
                                    {"mark_zones_greater_curvature", "1", 34},
                                    {"mark_zones_posterior", "1", 35},
                                    {"burn_zones", "1", 36},
                                    {"deep_burn_zones", "1", 37},
                                    {"bites", "1", 41},
                                    {"tear_outs", "1", 42},
                                    {"bites_full_thickness", "1", 43},
                                    {"bite_spacing_mean", "m", 44},
                                    {"bite_spacing_sd", "m", 45},
                                    {"bite_depth_mean", "m", 46},
                                    {"bite_depth_sd", "m", 47},
                                    {"full_thickness_share", "1", 48},
                                    {"bites_in_antrum", "1", 49},
                                    {"bites_in_fundus", "1", 50},
                                    {"bites_proximal", "1", 51},
                                    {"sets_proximal", "1", 52},
                                    {"sets", "1", 3},
                                    {"cinch_tension_mean", "N", 2.5},
                                    {"bites_per_5_min", "1", 10},
                                    {"mild_bleedings", "1", 61},
                                    {"brisk_bleedings", "1", 62},
                                    {"bleeding", "1", 63},
                                    {"blood_lost", "m^3", 65},
                                    {"reference_pressure", "Pa", 71},
                                    {"organ_pressure", "Pa", 72},
                                    {"lumen_area", "m^2", 73},
                                    {"organ_length", "m", 74},
                                    {"area_reduction", "1", 75},
                                    {"volume_reduction", "1", 76},
                                    {"length_reduction", "1", 77},
                                    {"coverage", "1", 0.5},
                                    {"coverage.cardia", "1", 0.1},
                                    {"coverage.fundus", "1", 0.2},
                                    {"coverage.body", "1", 0.3},
                                    {"coverage.antrum", "1", 0.4},
                                    {"coverage.pylorus", "1", 0.6},
                                    {"coverage.anterior", "1", 0.7},
                                    {"coverage.greater_curvature", "1", 0.8},
                                    {"coverage.posterior", "1", 0.9},
                                    {"coverage.lesser_curvature", "1", 1}};

TEST(Measures, eachHasTheValueOfASessionMadeForIt) {
  std::map<std::string, Measure> measures;
  for (const Measure& m : measuresOf(session(), sutures())) measures[m.name] = m;
  for (const Row& row : kExpected) {
    ASSERT_EQ(measures.count(row.name), 1U) << row.name;
    EXPECT_EQ(measures[row.name].unit, row.unit) << row.name;
    ASSERT_TRUE(measures[row.name].value) << row.name;
    EXPECT_DOUBLE_EQ(*measures[row.name].value, row.value) << row.name;
  }
}

TEST(Measures, thereAreNoOthersAndNoneTwice) {
  std::set<std::string> names, expected;
  const std::vector<Measure> measures = measuresOf(session(), sutures());
  for (const Measure& m : measures) names.insert(m.name.substr(0, m.name.find('.')));
  for (const Row& row : kExpected) expected.insert(std::string(row.name).substr(0, std::string(row.name).find('.')));
  EXPECT_EQ(names, expected);
  EXPECT_EQ(measures.size(), kExpected.size() + 9 * (kPhaseCount - 1));  // nine of each phase, of which one is above
}

TEST(Measures, whatTheSessionDoesNotDefineHasNoValue) {
  const std::vector<Measure> measures = measuresOf(SessionMetrics(), {});
  for (const char* name : {"log_dimensionless_jerk", "bite_spacing_mean", "cinch_tension_mean", "bites_per_5_min",
                           "area_reduction", "phase_max_force.suture"})
    EXPECT_FALSE(valueOf(measures, name)) << name;
  EXPECT_EQ(valueOf(measures, "bites"), 0.0);
}

TEST(Measures, whatIsNotANumberHasNoValue) {
  SessionMetrics m;
  m.max_force = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(valueOf(measuresOf(m, {}), "max_force"));
}

TEST(Measures, anUnknownNameIsAnError) {
  EXPECT_THROW(valueOf(measuresOf(SessionMetrics(), {}), "no_such"), Error);
}

// The summary prints the same numbers.
TEST(Measures, areThoseOfTheSummary) {
  const SessionMetrics m = session();
  const std::string text = summarise(m);
  EXPECT_NE(text.find("force on the tool      6.00 N max   7.00 N mean"), std::string::npos) << text;
  EXPECT_NE(text.find("path of the tip       5.000 m"), std::string::npos) << text;
  EXPECT_NE(text.find("bites                    41     missed 0   withdrawn 0   torn out 42"), std::string::npos)
      << text;
}

}  // namespace
}  // namespace vibe::measures_test
