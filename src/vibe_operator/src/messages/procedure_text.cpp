#include "vibe_operator/messages/procedure_text.hpp"

#include <algorithm>

#include "vibe_operator/messages/number_text.hpp"

namespace vibe::operating {

namespace {

constexpr std::array<const char*, kPhaseCount> kPhases = {"inspect", "mark", "suture", "pull", "done"};
constexpr std::size_t kHashShown = 8;  // digits: enough to tell two sessions apart by eye

std::string needleText(const vibe_msgs::ProcedureState& state) {
  if (!state.needle_loaded) return "No needle.";
  return state.needle_on_arm ? "Needle on the arm." : "Needle in the exchange.";
}

std::string stageText(const vibe_msgs::StageTime& stage) {
  return numberText(stage.p50, 1) + " / " + numberText(stage.p99, 1) + " / " + quantityText(stage.max, 1, "ms");
}

void addStage(const vibe_msgs::SolverStatistics& statistics, const std::string& stage, const std::string& name,
              const std::string& help, std::vector<NamedText>& rows) {
  const auto found = std::find_if(statistics.stages.begin(), statistics.stages.end(),
                                  [&](const vibe_msgs::StageTime& entry) { return entry.name == stage; });
  rows.push_back({name, found == statistics.stages.end() ? kNoValue : stageText(*found),
                  help + " Median, 99th percentile and greatest of the last window.", false});
}

}  // namespace

std::array<PhaseStep, kPhaseCount> phaseSteps(const std::string& phase) {
  std::array<PhaseStep, kPhaseCount> steps;
  const auto present = std::find(kPhases.begin(), kPhases.end(), phase);
  for (std::size_t i = 0; i < kPhases.size(); ++i) {
    steps[i].name = kPhases[i];
    if (present == kPhases.end()) continue;
    const auto here = kPhases.begin() + static_cast<std::ptrdiff_t>(i);
    steps[i].kind = here < present ? StepKind::Before : here == present ? StepKind::Present : StepKind::After;
  }
  return steps;
}

std::string toolText(const vibe_msgs::ProcedureState& state) {
  std::string tool = "Does '" + state.tool_state + "'.";
  if (state.tool_state == "grip") tool = "Holds tissue (" + countText(state.held_particles, "particle") + ").";
  if (state.tool_state == "insufflation") tool = "Gas flows in.";
  if (state.tool_state == "contact") tool = "Touches tissue.";
  if (state.tool_state == "free") tool = "Touches nothing.";
  return tool + " " + needleText(state);
}

std::string bitesText(const vibe_msgs::ProcedureState& state, const vibe_msgs::SutureArray* sutures) {
  std::string text;
  if (sutures && !sutures->sutures.empty() && sutures->sutures.back().stage == vibe_msgs::Suture::OPEN)
    text = std::to_string(sutures->sutures.back().bites.size()) + " in set " + std::to_string(sutures->sutures.size()) +
           ", ";
  text += std::to_string(state.bites) + " in all";
  if (state.tear_outs > 0) text += ", " + std::to_string(state.tear_outs) + " torn out";
  return text;
}

BleedingSummary summariseBleeding(const vibe_msgs::SutureArray& sutures) {
  BleedingSummary summary;
  summary.lost = sutures.blood_lost;
  for (const vibe_msgs::Bleeding& bleeding : sutures.bleedings) {
    if (!(bleeding.rate > 0)) continue;
    ++(bleeding.brisk ? summary.brisk : summary.mild);
    if (bleeding.brisk && bleeding.overdue) ++summary.overdue;
  }
  return summary;
}

std::string bleedingText(const BleedingSummary& bleeding) {
  std::string text;
  if (bleeding.brisk > 0) text = std::to_string(bleeding.brisk) + " brisk: complete the suture";
  if (bleeding.overdue > 0) text += ", overdue";
  if (bleeding.mild > 0) {
    text += (text.empty() ? "" : "; ") + std::to_string(bleeding.mild) + " mild";
    if (bleeding.brisk == 0) text += ", stops by itself";
  }
  return text.empty() ? "nothing bleeds" : text;
}

std::string marksText(const vibe_msgs::SkillMetrics& skill) {
  if (skill.mark_zones == 0) return "none";
  return countText(skill.mark_zones, "zone") + ", " + std::to_string(skill.mark_zones_inside) +
         " where sutures go: anterior " + std::to_string(skill.mark_zones_anterior) + ", greater curvature " +
         std::to_string(skill.mark_zones_greater_curvature) + ", posterior " +
         std::to_string(skill.mark_zones_posterior);
}

std::string burnsText(const vibe_msgs::SkillMetrics& skill) {
  if (skill.burn_zones == 0) return "none";
  return countText(skill.burn_zones, "burn scar") + ", " + std::to_string(skill.deep_burn_zones) +
         " with the muscularis at risk";
}

std::vector<NamedText> solverStatisticsRows(const vibe_msgs::SolverStatistics& statistics) {
  std::vector<NamedText> rows;
  addStage(statistics, "solver", "Solver", "CPU time of a step.", rows);
  addStage(statistics, "total", "Whole step", "Wall time of a step with all messages.", rows);
  rows.push_back({"Real-time factor", numberText(statistics.real_time_factor, 2),
                  "Simulated time over wall time; 0 while paused.", false});
  rows.push_back({"Missed deadlines", std::to_string(statistics.missed_deadlines),
                  "Steps of the last window that began more than a step period late.",
                  statistics.missed_deadlines > 0});
  rows.push_back({"Particles",
                  std::to_string(statistics.active_count) + " of " + std::to_string(statistics.particle_count) +
                      " awake, " + std::to_string(statistics.contact_count) + " points of contact",
                  "Particles that are simulated, and points where the tool touches the wall.", false});
  rows.push_back({"State hash", statistics.state_hash.empty() ? kNoValue : statistics.state_hash.substr(0, kHashShown),
                  "Equal hashes at equal steps mean equal sessions; whole: " + statistics.state_hash, false});
  return rows;
}

namespace {

using Goal = vibe_msgs::GoalProgress;

std::string nameOf(const Goal& goal) {
  return goal.label.empty() ? goal.goal : goal.goal + " (" + goal.label + ")";
}

std::string countsText(const vibe_msgs::TraineeProgress& progress) {
  const auto count = [&progress](std::uint8_t state) {
    return std::to_string(std::count_if(progress.goals.begin(), progress.goals.end(),
                                        [state](const Goal& goal) { return goal.state == state; }));
  };
  std::string text =
      count(Goal::REACHED) + " reached, " + count(Goal::FAILED) + " failed, " + count(Goal::QUEUED) + " queued";
  return progress.skill.empty() ? text : progress.skill + ": " + text;
}

}  // namespace

std::string traineeText(const vibe_msgs::TraineeProgress& progress) {
  if (progress.goals.empty()) return progress.skill.empty() ? "no goals" : progress.skill + ": no goals";
  std::string text = countsText(progress);
  const Goal* failed = nullptr;
  for (const Goal& goal : progress.goals) {
    if (goal.state == Goal::FAILED) failed = &goal;
    if (goal.state != Goal::ACTIVE) continue;
    text += "\nNow: " + nameOf(goal);
    if (!goal.activity.empty() && goal.activity != goal.goal) text += ", " + goal.activity;
  }
  if (failed) text += "\nLast failed: " + nameOf(*failed) + ": " + failed->reason;
  return text;
}

}  // namespace vibe::operating
