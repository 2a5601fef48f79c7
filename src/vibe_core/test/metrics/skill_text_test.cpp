#include "metrics/skill_text.hpp"

#include <gtest/gtest.h>

#include <sstream>
#include <vector>

#include "vibe_core/metrics/session_metrics.hpp"

namespace vibe::skill_text_test {
namespace {

std::vector<std::string> lines(const std::string& text) {
  std::vector<std::string> result;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) result.push_back(line);
  return result;
}

SkillMetrics session() {
  SkillMetrics m;
  PhaseSkill& suture = m.phases.phase[static_cast<int>(Phase::Suture)];
  suture.time = 123.456;
  suture.motion.path_length = 2.5;
  suture.motion.submovements = 42;
  suture.motion.economy = 0.75;
  suture.motion.log_dimensionless_jerk = -17.25;
  suture.motion.spectral_arc_length = -2.5;
  suture.force.loaded_time = 10;
  suture.force.max = 6.5;
  suture.force.mean = 1.25;
  suture.force.time_above = 0.5;
  m.phases.whole = suture;
  m.marks.zones = 12;
  m.marks.inside = 11;
  m.marks.wall = {5, 4, 3, 0};
  m.marks.burns = 2;
  m.marks.deep_burns = 1;
  m.bites.taken = 9;
  m.bites.torn_out = 1;
  m.bites.full_thickness_share = 0.875;
  m.bites.spacing_mean = 0.0182;
  m.bites.spacing_sd = 0.0031;
  m.bites.depth_mean = 4.1e-3;
  m.bites.in_antrum = 1;
  m.bites.in_fundus = 2;
  m.bites.bites_proximal = 0.5;
  m.sets.resize(2);
  SetSkill& set = m.sets[0];
  set.stage = Suture::Stage::Cinched;
  set.loose = true;
  set.named = true;
  set.technique = Technique::Triangular;
  set.margin = 0.93;
  set.bites = 7;
  set.torn_out = 1;
  set.along = 0.71;
  set.spacing_mean = 0.0182;
  set.thread = 0.0451;
  set.drawn = 0.0802;
  set.cinch_tension = 0.31;
  set.tension = 0.28;
  set.duration = 75.2;
  m.sets[1].bites = 1;
  m.bleeding.mild = 3;
  m.bleeding.brisk = 2;
  m.bleeding.now = 1;
  m.bleeding.overdue = 1;
  m.bleeding.lost = 2.3e-6;
  m.mistakes = {4, 5, 6, 7, 8};
  m.organ.reference = OrganReference::SetPoint;
  m.organ.reference_pressure = 2000;
  m.organ.pressure = 1600;
  m.organ.before.emplace().volume = 1.2e-3;
  m.organ.now.emplace().volume = 0.9e-3;
  m.organ.before->mean_area = 60e-4;
  m.organ.now->mean_area = 40e-4;
  m.organ.area_reduction = 1.0 / 3;
  m.organ.volume_reduction = 0.25;
  return m;
}

TEST(SkillText, ofAWholeSession) {
  const std::vector<std::string> expected = {
      "phase        time s    path m     LDLJ   SPARC  submov.  economy   max N  mean N  > 5 N s",
      "suture       123.46     2.500   -17.25   -2.50       42     0.75    6.50    1.25     0.50",
      "whole        123.46     2.500   -17.25   -2.50       42     0.75    6.50    1.25     0.50",
      "marks                    12     in the zone 11   anterior 5   greater curvature 4   posterior 3   burns 2   "
      "deep 1",
      "bites                     9     missed 4   withdrawn 5   torn out 1   of full thickness 87.5 %",
      "  spacing              18.2 mm   +- 3.1   depth 4.1 mm   +- -",
      "  off the body            3     antrum 1   fundus 2   proximally 50.0 % of bites, - of sets",
      "set  technique  margin  bites  torn  along  spacing mm  thread mm  drawn mm  cinch N  now N  time s",
      "  1  triangular   0.93      7     1   0.71        18.2       45.1      80.2     0.31   0.28    75.2  loose",
      "  2  -               -      1     0      -           -          -       0.0        -   0.00       -  open",
      "bleeding               2.30 mL lost   mild 3   brisk 2   now 1   overdue 1",
      "mistakes                  8 rejected   slips 6   torn out 1   threads broken 7",
      "organ                  12.0 mmHg now   15.0 mmHg before (set point)",
      "  area of the body     40.0 cm2 before 60.0   reduced by 33.3 %",
      "  volume              900.0 mL  before 1200.0   reduced by 25.0 %",
      "  length                  - mm  before -   reduced by -",
  };
  EXPECT_EQ(lines(summarise(session())), expected);
}

TEST(SkillText, namesOnlyPhasesThatWere) {
  SkillMetrics m;
  m.phases.phase[static_cast<int>(Phase::Inspect)].time = 1;
  m.phases.phase[static_cast<int>(Phase::Done)].time = 2;
  const std::vector<std::string> text = lines(summarise(m));
  EXPECT_EQ(text[1].substr(0, 7), "inspect");
  EXPECT_EQ(text[2].substr(0, 4), "done");
  EXPECT_EQ(text[3].substr(0, 5), "whole");
}

TEST(SkillText, whatIsNotDefinedIsADash) {
  const std::string text = summarise(SkillMetrics());
  EXPECT_EQ(text.find("nan"), std::string::npos);
  EXPECT_NE(text.find("sets                      -"), std::string::npos);
  EXPECT_NE(text.find("of full thickness -"), std::string::npos);
  EXPECT_NE(text.find("reduced by -\n"), std::string::npos);
  EXPECT_NE(text.back(), '\n');
}

TEST(SkillText, zeroHasNoSign) {
  SkillMetrics m = session();
  m.organ.volume_reduction = -1e-5;
  EXPECT_NE(summarise(m).find("reduced by 0.0 %"), std::string::npos);
  SessionMetrics energies;
  energies.energy_balance = energies.energy.residual_work = -1e-9;
  EXPECT_NE(summarise(energies).find("residuals 0.0000 J   energy balance 0.0000 J"), std::string::npos);
}

TEST(SkillText, saysWhenCorrectionsAreMoreThanAHundredthOfTheWork) {
  SessionMetrics m;
  m.energy.tool_work = -0.5, m.energy.gas_work = 0.5;
  m.energy.correction_work = 0.009;
  EXPECT_EQ(summarise(m).find("doubtful"), std::string::npos);
  m.energy.correction_work = 0.25;
  EXPECT_NE(summarise(m).find("The corrections are 25 % of the work put in: walls or tool were stopped"),
            std::string::npos);
  m.energy.correction_work = -0.25;
  EXPECT_NE(summarise(m).find("The corrections are 25 %"), std::string::npos);
}

TEST(SkillText, saysWhenTheEnergyBalanceDoesNotClose) {
  SessionMetrics m;
  m.energy.thread_work = 1;
  m.energy_balance = -0.009;
  EXPECT_EQ(summarise(m).find("doubtful"), std::string::npos);
  m.energy_balance = -0.02;
  EXPECT_NE(summarise(m).find("The energy balance is off by 2 % of the work put in"), std::string::npos);
  m.balance_closes = false;
  EXPECT_EQ(summarise(m).find("doubtful"), std::string::npos);
}

TEST(SkillText, doesNotDoubtASessionInWhichNothingHappens) {
  SessionMetrics m;
  m.energy.correction_work = m.energy_balance = 9e-6;
  EXPECT_EQ(summarise(m).find("doubtful"), std::string::npos);
}

TEST(SkillText, saysWhyAnOrganIsNotMeasured) {
  SkillMetrics m;
  m.organ.fault = "The surface is not closed; close it.";
  EXPECT_NE(summarise(m).find("organ                     -     The surface is not closed; close it."),
            std::string::npos);
}

}  // namespace
}  // namespace vibe::skill_text_test
