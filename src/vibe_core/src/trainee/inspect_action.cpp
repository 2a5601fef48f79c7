#include <cmath>
#include <cstdio>

#include "trainee/picture.hpp"
#include "trainee/travel.hpp"

namespace vibe {

namespace {

constexpr double kHalfView = 0.87;     // 50 degrees; a gastroscope's picture is 140 degrees wide across its corners
constexpr double kFarthestView = 1.5;  // distance at which a place still counts as seen, of the wanted one [1]

}  // namespace

GoalResult perform(const InspectGoal& goal, Operator& me) {
  const WallPoint target = find(goal.place, me.map());
  const std::array<double, kJointCount> joints = bestView(me.position(target), me.outward(target), goal.distance, me);
  if (!travel(joints, me)) return {false, "the scope met a wall on its way"};
  me.hand.wait(me.skill().reaction_time + goal.time);
  const View view = viewOf(me.position(target), me.view());
  const bool seen = view.angle < kHalfView && view.distance < kFarthestView * goal.distance;
  char text[160];
  std::snprintf(text, sizeof text, "%s from %.0f mm, %.0f deg off the middle of the picture",
                seen ? "seen" : "the scope does not get the place into its picture: it is seen", 1e3 * view.distance,
                view.angle * 180 / M_PI);
  return {seen, text};
}

}  // namespace vibe
