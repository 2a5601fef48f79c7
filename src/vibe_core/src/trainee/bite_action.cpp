#include "trainee/bite_attempt.hpp"
#include "trainee/operator.hpp"

namespace vibe {

namespace {

constexpr double kNextTime =
    0.5;  // part of a surprise that is expected of the next bite, beside the last; measured [1]

}  // namespace

GoalResult takeBite(const WallPoint& target, Operator& me) {
  if (!me.model().scene.helix || !me.model().scene.suture)
    return {false, "the scene has no helix or no suture; add 'helix: {}' and 'suture: {}'"};
  GoalResult result;
  me.surprise *= kNextTime;
  me.hand.wait(me.skill().look_time);
  for (int attempt = 0; attempt < me.skill().attempts; ++attempt) {
    result = BiteAttempt(target, attempt, me).make();
    if (result.reached) return result;
    me.say("try " + std::to_string(attempt + 1) + " of " + std::to_string(me.skill().attempts) + ": " + result.reason);
  }
  return result;
}

GoalResult perform(const BiteGoal& goal, Operator& me) {
  return takeBite(find(goal.place, me.map()), me);
}

}  // namespace vibe
