#include <algorithm>

#include "trainee/ik_solution.hpp"
#include "trainee/operator.hpp"

namespace vibe {

namespace {

constexpr double kFirstInsertion = 0.06;  // [m]
constexpr double kBeamGap = 3e-3;         // from the probe to the wall [m]

}  // namespace

GoalResult perform(const InsufflateGoal& goal, Operator& me) {
  if (me.hand.joints()[Insertion] < kFirstInsertion) me.hand.move(Insertion, kFirstInsertion, 1);
  me.hand.press(Insufflate);
  if (!me.hand.await([&] { return me.view().pressure_reached; }, goal.patience))
    return {false, "the pressure did not reach its set point"};
  return {true, ""};
}

GoalResult perform(const MarkGoal& goal, Operator& me) {
  if (!me.model().scene.marking) return {false, "the scene has no argon beam"};
  const double probe = me.model().scene.marking->apc.probe_length;
  const Eigen::Vector2d error = me.nextAimError();
  const AnatomicalMap& map = me.map();
  const WallPoint target = map.walk(find(goal.place, map), error[0], error[1]);
  for (const double off : {0.02, 0.0}) {
    const Eigen::Vector3d outward = me.outward(target);
    const IkSolution aim = aimAt(me.model(), me.position(target) - (probe + kBeamGap + off) * outward, outward,
                                 Eigen::Vector3d::Zero(), me.hand.joints());
    me.hand.moveTo(aim.joints, off > 0 ? 0.5 : 0.3, [&] { return me.hand.feelsTooMuch(); });
  }
  me.hand.wait(me.skill().reaction_time);
  me.hand.forget();
  me.hand.hold(ApcPedal, goal.time);
  me.hand.wait(me.skill().reaction_time);
  if (!me.hand.happened(Event::Kind::Mark)) return {false, "the beam left no mark"};
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
