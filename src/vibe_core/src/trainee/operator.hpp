#pragma once
#include <cstdint>
#include <functional>
#include <string>

#include "trainee/hand.hpp"
#include "vibe_core/geometry/anatomical_map.hpp"
#include "vibe_core/trainee/goal.hpp"

namespace vibe {

/// What the actions of a trainee share: hands, knowledge of the organ, random errors, and how to say what is going on.
struct Operator {
  Hand& hand;
  std::uint64_t random;                               ///< state of the generator of errors
  std::function<void(const std::string&)> say;        ///< what is being done

  const Model& model() const { return hand.model(); }
  const Skill& skill() const { return hand.skill(); }
  const Observation& view() const { return hand.view(); }

  AnatomicalMap lookAround() const { return {model().organ, view().wall}; }
  Eigen::Vector3d place(const WallPoint& point) const {
    return positionOf(point, model().organ.surface.triangles, view().wall);
  }
  double nextNormal();
  /// Aim error along the wall [m].
  Eigen::Vector2d nextAimError();
};

/// Point of the wall at a place, now.
WallPoint find(const Place& place, const AnatomicalMap& map);

// One file each. All return when the goal is reached or given up.
GoalResult perform(const InsufflateGoal& goal, Operator& me);
GoalResult perform(const MarkGoal& goal, Operator& me);
GoalResult perform(const BiteGoal& goal, Operator& me);
GoalResult perform(const SutureSetGoal& goal, Operator& me);
GoalResult perform(const CinchGoal& goal, Operator& me);
GoalResult perform(const WithdrawGoal& goal, Operator& me);
GoalResult perform(const WaitGoal& goal, Operator& me);

/// One bite at a point of the wall.
GoalResult takeBite(const WallPoint& target, Operator& me);
/// The scope straight and near its entry, out of the way.
void stepBack(Operator& me);

}  // namespace vibe
