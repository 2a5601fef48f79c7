#include "vibe_operator/messages/procedure_text.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace vibe::operating::procedure_text_test {
namespace {

vibe_msgs::Bleeding makeBleeding(bool brisk, double rate, bool overdue = false) {
  vibe_msgs::Bleeding bleeding;
  bleeding.brisk = brisk;
  bleeding.rate = rate;
  bleeding.overdue = overdue;
  return bleeding;
}

TEST(ProcedureText, onePhaseIsThePresentOne) {
  const auto steps = phaseSteps("suture");
  EXPECT_EQ(steps[0].name, "inspect");
  EXPECT_EQ(steps[4].name, "done");
  EXPECT_EQ(steps[0].kind, StepKind::Before);
  EXPECT_EQ(steps[1].kind, StepKind::Before);
  EXPECT_EQ(steps[2].kind, StepKind::Present);
  EXPECT_EQ(steps[3].kind, StepKind::After);
  EXPECT_EQ(phaseSteps("inspect")[0].kind, StepKind::Present);
  EXPECT_EQ(phaseSteps("done")[4].kind, StepKind::Present);
}

TEST(ProcedureText, anUnknownPhaseIsNone) {
  for (const char* name : {"", "Suture", "lunch"})
    for (const PhaseStep& step : phaseSteps(name)) EXPECT_EQ(step.kind, StepKind::After) << name;
}

TEST(ProcedureText, theToolAndTheNeedle) {
  vibe_msgs::ProcedureState state;
  state.tool_state = "grip";
  state.held_particles = 12;
  EXPECT_EQ(toolText(state), "Holds tissue (12 particles). No needle.");
  state.tool_state = "free";
  state.needle_loaded = true;
  EXPECT_EQ(toolText(state), "Touches nothing. Needle in the exchange.");
  state.needle_on_arm = true;
  state.tool_state = "dances";
  EXPECT_EQ(toolText(state), "Does 'dances'. Needle on the arm.");
}

TEST(ProcedureText, bitesOfTheOpenSetComeFirst) {
  vibe_msgs::ProcedureState state;
  state.bites = 9;
  vibe_msgs::SutureArray sutures;
  sutures.sutures.resize(2);
  sutures.sutures[0].stage = vibe_msgs::Suture::CINCHED;
  sutures.sutures[0].bites.resize(7);
  sutures.sutures[1].bites.resize(2);
  EXPECT_EQ(bitesText(state, &sutures), "2 in set 2, 9 in all");
  sutures.sutures[1].stage = vibe_msgs::Suture::TAGGED;
  state.tear_outs = 1;
  EXPECT_EQ(bitesText(state, &sutures), "9 in all, 1 torn out");
  EXPECT_EQ(bitesText({}, nullptr), "0 in all");
}

TEST(ProcedureText, onlyWhatBleedsNowBleeds) {
  vibe_msgs::SutureArray sutures;
  EXPECT_EQ(bleedingText(summariseBleeding(sutures)), "nothing bleeds");
  sutures.bleedings = {makeBleeding(true, 0), makeBleeding(false, std::numeric_limits<double>::quiet_NaN())};
  EXPECT_EQ(bleedingText(summariseBleeding(sutures)), "nothing bleeds");
  sutures.bleedings.push_back(makeBleeding(false, 1e-8));
  EXPECT_EQ(bleedingText(summariseBleeding(sutures)), "1 mild, stops by itself");
  sutures.bleedings.push_back(makeBleeding(true, 1e-7));
  EXPECT_EQ(bleedingText(summariseBleeding(sutures)), "1 brisk: complete the suture; 1 mild");
  sutures.bleedings.back().overdue = true;
  EXPECT_EQ(summariseBleeding(sutures).overdue, 1u);
  EXPECT_EQ(bleedingText(summariseBleeding(sutures)), "1 brisk: complete the suture, overdue; 1 mild");
}

TEST(ProcedureText, marksByWall) {
  vibe_msgs::SkillMetrics skill;
  EXPECT_EQ(marksText(skill), "none");
  EXPECT_EQ(burnsText(skill), "none");
  skill.mark_zones = 3;
  skill.mark_zones_inside = 2;
  skill.mark_zones_anterior = 1;
  skill.mark_zones_posterior = 2;
  skill.burn_zones = 1;
  EXPECT_EQ(marksText(skill), "3 zones, 2 where sutures go: anterior 1, greater curvature 0, posterior 2");
  EXPECT_EQ(burnsText(skill), "1 burn scar, 0 with the muscularis at risk");
}

TEST(ProcedureText, statisticsByName) {
  vibe_msgs::SolverStatistics statistics;
  statistics.stages.resize(2);
  statistics.stages[0].name = "publish";
  statistics.stages[0].p50 = 99;
  statistics.stages[1].name = "solver";
  statistics.stages[1].p50 = 4.25;
  statistics.stages[1].p99 = 6.5;
  statistics.stages[1].max = 8;
  statistics.state_hash = "0123456789abcdef";
  const auto rows = solverStatisticsRows(statistics);
  EXPECT_EQ(rows[0].value, "4.2 / 6.5 / 8.0 ms");
  EXPECT_EQ(rows[1].value, "\u2013") << "there is no stage 'total'";
  EXPECT_EQ(rows.back().value, "01234567");
  EXPECT_NE(rows.back().help.find(statistics.state_hash), std::string::npos);
}

TEST(ProcedureText, missedDeadlinesWarn) {
  const auto warnings = [](std::uint32_t missed) {
    vibe_msgs::SolverStatistics statistics;
    statistics.missed_deadlines = missed;
    int count = 0;
    for (const NamedText& row : solverStatisticsRows(statistics)) count += row.warns ? 1 : 0;
    return count;
  };
  EXPECT_EQ(warnings(0), 0);
  EXPECT_EQ(warnings(1), 1);
}

}  // namespace
}  // namespace vibe::operating::procedure_text_test
