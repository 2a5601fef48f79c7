#pragma once

#include <array>
#include <string>
#include <vector>

#include <vibe_msgs/ProcedureState.h>
#include <vibe_msgs/SkillMetrics.h>
#include <vibe_msgs/SolverStatistics.h>
#include <vibe_msgs/SutureArray.h>
#include <vibe_msgs/TraineeProgress.h>

namespace vibe::operating {

/// The procedure's phases as a row of steps.
enum class StepKind { Before, Present, After };
struct PhaseStep {
  std::string name;                 ///< "inspect", "mark", "suture", "pull", "done"
  StepKind kind = StepKind::After;  ///< where it lies from the present one
};
constexpr int kPhaseCount = 5;  ///< of phaseSteps()

/// With an unknown phase no step is the present one and none lies behind.
std::array<PhaseStep, kPhaseCount> phaseSteps(const std::string& phase);

/// What the tool does now: "Holds tissue. Needle on the arm."
std::string toolText(const vibe_msgs::ProcedureState& state);

/// "7 in set 2, 14 in all"; without an open set only the second.
std::string bitesText(const vibe_msgs::ProcedureState& state, const vibe_msgs::SutureArray* sutures);

/// What bleeds now, and how much was lost.
struct BleedingSummary {
  unsigned mild = 0, brisk = 0, overdue = 0;  ///< overdue ones are brisk as well
  double lost = 0;                            ///< [m^3]
};
/// Counts what bleeds.
BleedingSummary summariseBleeding(const vibe_msgs::SutureArray& sutures);
/// "nothing bleeds", or how many wounds do and what helps.
std::string bleedingText(const BleedingSummary& bleeding);

/// "11 zones, 10 where sutures go: anterior 4, greater curvature 4, posterior 3".
std::string marksText(const vibe_msgs::SkillMetrics& skill);
/// "none", or "2 burn scars, 1 with the muscularis at risk".
std::string burnsText(const vibe_msgs::SkillMetrics& skill);

/// A row of a list of values.
struct NamedText {
  std::string name, value, help;  ///< help: what the value is, in a sentence
  bool warns = false;             ///< the value is out of order
};
/// How well the simulator keeps up.
std::vector<NamedText> solverStatisticsRows(const vibe_msgs::SolverStatistics& statistics);

/// What a trainee does and how far it is, in a few lines: the goal that is pursued, or how many have ended; what is
/// being done; why the last failed goal failed.
std::string traineeText(const vibe_msgs::TraineeProgress& progress);

}  // namespace vibe::operating
