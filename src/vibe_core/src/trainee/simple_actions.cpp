#include <algorithm>

#include "trainee/operator.hpp"

namespace vibe {

namespace {

constexpr double kFirstInsertion = 0.06;  // [m]

}  // namespace

GoalResult perform(const InsufflateGoal& goal, Operator& me) {
  if (!me.model().scene.gas) return {false, "the scene has no gas; add 'gas: {}'"};
  if (me.hand.joints()[Insertion] < kFirstInsertion) me.hand.move(Insertion, kFirstInsertion, 1);
  me.hand.press(Insufflate);
  if (!me.hand.await([&] { return me.view().pressure_reached; }, goal.patience))
    return {false, "the pressure did not reach its set point"};
  return {true, ""};
}

GoalResult perform(const WithdrawGoal& goal, Operator& me) {
  stepBack(me);
  me.hand.move(Insertion, goal.insertion, 1);
  me.hand.release(Insufflate);
  me.hand.wait(0.5);
  return {true, ""};
}

GoalResult perform(const WaitGoal& goal, Operator& me) {
  me.hand.wait(goal.time);
  return {true, ""};
}

}  // namespace vibe
