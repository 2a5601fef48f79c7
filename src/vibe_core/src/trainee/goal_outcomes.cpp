#include "vibe_core/trainee/goal_outcomes.hpp"

#include <variant>

namespace vibe {
namespace {

int countReached(const Trainee& trainee) {
  int count = 0;
  for (const GoalResult& result : trainee.results()) count += result.reached ? 1 : 0;
  return count;
}

int countAsPlanned(const Trainee& trainee, const std::vector<SetSkill>& sets) {
  std::size_t k = 0;
  int count = 0;
  for (const Goal& goal : trainee.goals()) {
    const auto* planned = std::get_if<SutureSetGoal>(&goal);
    if (planned == nullptr || k >= sets.size()) continue;
    if (sets[k].named && sets[k].technique == planned->pattern) ++count;
    ++k;
  }
  return count;
}

}  // namespace

std::vector<GoalOutcome> goalOutcomes(const Trainee& trainee) {
  std::vector<GoalOutcome> outcomes;
  const std::vector<GoalResult>& results = trainee.results();
  for (std::size_t k = 0; k < trainee.goals().size(); ++k) {
    const GoalResult result = k < results.size() ? results[k] : GoalResult{false, "not ended"};
    outcomes.push_back({describe(trainee.goals()[k]), result.reached, result.reason});
  }
  return outcomes;
}

std::vector<Measure> goalMeasures(const Trainee* trainee, const std::vector<SetSkill>& sets) {
  if (trainee == nullptr) return {{"goals", "1", {}}, {"goals_reached", "1", {}}, {"sets_as_planned", "1", {}}};
  return {{"goals", "1", static_cast<double>(trainee->goals().size())},
          {"goals_reached", "1", countReached(*trainee)},
          {"sets_as_planned", "1", countAsPlanned(*trainee, sets)}};
}

}  // namespace vibe
