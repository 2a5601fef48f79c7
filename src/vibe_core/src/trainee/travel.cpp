#include "trainee/travel.hpp"

#include <algorithm>
#include <cmath>

namespace vibe {

namespace {

constexpr double kLeastInsertion = 0.05;  // with which the scope turns, straight, in the entry; design choice [m]
constexpr double kSmallTurn = 0.5;        // of a joint, up to which the way is direct; design choice [rad]

double turnBetween(const TraineeHand::Joints& a, const TraineeHand::Joints& b) {
  double turn = 0;
  for (int j = Rotation; j <= TipLeftRight; ++j) turn = std::max(turn, std::abs(a[j] - b[j]));
  return turn;
}

// Straight, in the entry: from there every place is reached on the way on which the scope comes back as well.
TraineeHand::Joints straight(const TraineeHand::Joints& joints) {
  TraineeHand::Joints out = joints;
  out[Insertion] = std::min(joints[Insertion], kLeastInsertion);
  out[TipUpDown] = out[TipLeftRight] = 0;
  return out;
}

}  // namespace

void retreat(Operator& me) {
  me.hand.moveTo(straight(me.hand.joints()), 0.5);
  me.hand.wait(me.skill().reaction_time);
}

bool travel(const TraineeHand::Joints& joints, Operator& me) {
  const auto tooMuch = [&me] { return me.hand.feelsTooMuch(); };
  if (tooMuch() || turnBetween(me.hand.joints(), joints) > kSmallTurn) {
    retreat(me);
    me.hand.move(Rotation, joints[Rotation], 0.2);
  }
  const bool arrived = me.hand.moveTo(joints, 0.3, tooMuch);
  if (!arrived) retreat(me);
  return arrived;
}

}  // namespace vibe
