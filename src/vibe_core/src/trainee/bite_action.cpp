#include "trainee/bite_attempt.hpp"
#include "trainee/operator.hpp"

namespace vibe {

GoalResult takeBite(const WallPoint& target, Operator& me) {
  GoalResult result;
  Eigen::Vector2d learned = Eigen::Vector2d::Zero();
  for (int attempt = 0; attempt < me.skill().attempts; ++attempt) {
    result = BiteAttempt(target, attempt, learned, me).make();
    if (result.reached) return result;
    me.say("try " + std::to_string(attempt + 1) + " of " + std::to_string(me.skill().attempts) + ": " + result.reason);
  }
  return result;
}

GoalResult perform(const BiteGoal& goal, Operator& me) {
  return takeBite(find(goal.place, me.map()), me);
}

}  // namespace vibe
