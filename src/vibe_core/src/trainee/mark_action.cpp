#include <cmath>

#include "trainee/picture.hpp"
#include "trainee/travel.hpp"

namespace vibe {

namespace {

constexpr double kBeamGap = 3e-3;  // from the probe to the wall [m]
constexpr double kAimed = 2e-3;    // of the beam from its target, and of the probe from its distance [m]
constexpr int kCorrections = 3;    // of the tip, before the pedal is pressed

// Brings the probe before the wall; what the last motion missed is added to the next.
bool approachMark(const WallPoint& target, double distance, Operator& me) {
  Eigen::Vector3d correction = Eigen::Vector3d::Zero();
  for (int k = 0; k < kCorrections; ++k) {
    const Eigen::Vector3d place = me.position(target);
    const TraineeHand::Joints joints = bestView(place + correction, me.outward(target), distance, me);
    if (!travel(joints, me)) return false;
    me.hand.wait(me.skill().reaction_time + 0.1);
    const View view = viewOf(place, me.view());
    const Eigen::Vector3d miss =
        place - (me.view().tip + view.distance * (me.view().tip_turn * Eigen::Vector3d::UnitX()));
    if (miss.norm() < kAimed && std::abs(view.distance - distance) < kAimed) return true;
    correction += miss + (view.distance - distance) * me.outward(target);
  }
  return true;
}

bool burn(double time, Operator& me) {
  me.hand.forget();
  me.hand.hold(ApcPedal, time);
  me.hand.wait(me.skill().reaction_time);
  return me.hand.happened(Event::Kind::Mark);
}

}  // namespace

GoalResult perform(const MarkGoal& goal, Operator& me) {
  if (!me.model().scene.marking) return {false, "the scene has no argon beam; add 'marking: {}'"};
  const double probe = me.model().scene.marking->apc.probe_length;
  const WallPoint place = find(goal.place, me.map());
  GoalResult result{false, ""};
  for (int k = 0; k < me.skill().attempts && !result.reached; ++k) {
    if (!approachMark(me.withAimError(place), probe + kBeamGap, me))
      result.reason = "the scope met a wall on its way";
    else if (burn(goal.time, me))
      result = {true, ""};
    else
      result.reason = "the beam left no mark";
  }
  return result;
}

}  // namespace vibe
