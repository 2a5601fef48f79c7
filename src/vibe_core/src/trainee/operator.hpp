#pragma once
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "trainee/trainee_hand.hpp"
#include "vibe_core/geometry/anatomical_map.hpp"
#include "vibe_core/trainee/goal.hpp"

namespace vibe {

/// What the actions of a trainee share: hands, knowledge of the organ, random errors, and how to say what is going on.
struct Operator {
  TraineeHand& hand;
  std::uint64_t random;                         ///< state of the generator of errors
  std::function<void(const std::string&)> say;  ///< what is being done

  const Model& model() const { return hand.model(); }
  const Skill& skill() const { return hand.skill(); }
  const Observation& view() const { return hand.view(); }

  /// The organ as it was when the trainee last looked at it while no thread held it. Places are found in this map;
  /// the points of the wall that are found there move with the tissue.
  const AnatomicalMap& map();
  std::shared_ptr<const AnatomicalMap> seen_map;           ///< empty: has not looked yet
  Eigen::Vector3d position(const WallPoint& point) const;  ///< now, in world [m]
  Eigen::Vector3d outward(const WallPoint& point) const;   ///< now

  /// How far from the helix the wall followed it in the last bites, see ImaginedDraw [m].
  double follows = 0.14;
  /// What the needle missed in the last bite beyond what had been imagined: distal, anterior [m].
  Eigen::Vector2d surprise = Eigen::Vector2d::Zero();

  double nextNormal();
  /// What is really aimed at: a point of the wall beside the target, Skill::aim_error away in each direction. Nobody
  /// aims beside the organ: where the error leads out of it, the target itself.
  WallPoint withAimError(const WallPoint& target);
};

/// Point of the wall at a place, now.
WallPoint find(const Place& place, const AnatomicalMap& map);

// One file each. All return when the goal is reached or given up.
GoalResult perform(const InsufflateGoal& goal, Operator& me);
GoalResult perform(const InspectGoal& goal, Operator& me);
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
