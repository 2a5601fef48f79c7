#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "vibe_core/metrics/session_outcome.hpp"
#include "vibe_core/model/model.hpp"
#include "vibe_core/trainee/observation.hpp"
#include "vibe_core/trainee/protocol.hpp"
#include "vibe_core/trainee/skill.hpp"

namespace vibe {

/// A trainee that looks: it pursues goals one after the other, sees and feels what the simulator publishes, and moves
/// the seven joints and six buttons as a person would. Its decisions are a pure function of model, skill, seed, goals
/// and observations.
///
///   Trainee trainee(model, Skill::expert(), seed);
///   trainee.add(InsufflateGoal{});
///   while (!trainee.done()) simulation.step(trainee.next(observe(simulation)));
class Trainee {
 public:
  /// @throws Error if the scene has no scope
  Trainee(std::shared_ptr<const Model> model, const Skill& skill, std::uint64_t seed);
  ~Trainee();
  Trainee(const Trainee&) = delete;
  Trainee& operator=(const Trainee&) = delete;

  /// @return the number of the goal, from 0
  /// @throws Error if it is a SurveyGoal and a mesh of the device cannot be read
  int add(const Goal& goal);
  /// Gives a goal up, now or when its turn comes: lets go of everything, draws back, and goes on with the next. No
  /// effect on goals that have ended.
  void cancel(int number);
  /// Perceives the end of a step.
  /// @return the input of the next step, which is decided on what was perceived Skill::reaction_time ago
  StepInput next(Observation seen);

  bool done() const;                               ///< every goal has ended
  int current() const;                             ///< number of the goal that is pursued, or of goals, if none is left
  const std::string& activity() const;             ///< what it is doing: "bite 3 of 7, second try"
  const std::vector<Goal>& goals() const;          ///< all that were added, by number
  const std::vector<GoalResult>& results() const;  ///< one per goal that has ended

  /// Called when the activity changes; may be empty.
  std::function<void(const std::string&)> on_activity;
  /// Called when a goal has ended, with its number; may be empty.
  std::function<void(int, const GoalResult&)> on_result;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// What became of the goals of a trainee, in their order.
std::vector<GoalOutcome> goalOutcomes(const Trainee& trainee);

/// Measures of a protocol: `goals`, `goals_reached`, `sets_as_planned`, the sets whose recognised technique is that of
/// their goal, and `bites_planned` and `bites_given_up` of the goals that have ended.
/// @param trainee  null: the same names without values
/// @param sets     of the session
std::vector<Measure> goalMeasures(const Trainee* trainee, const std::vector<SetSkill>& sets);

}  // namespace vibe
