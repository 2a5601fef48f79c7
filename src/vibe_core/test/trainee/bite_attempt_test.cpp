// What a trainee does when something presses on its way to the wall.
#include "trainee/bite_attempt.hpp"

#include <gtest/gtest.h>

#include "onlooker.hpp"

namespace vibe::bite_attempt_test {
namespace {

GoalResult attemptUnder(double force, TraineeHand::Joints& joints) {
  Onlooker at(Skill::expert(), [force](Observation& seen) { seen.force = {force, 0, 0}; });
  const GoalResult result = BiteAttempt(at.me.seen_map->at(0.5, 0.3), 0, at.me).make();
  joints = at.hand.joints();
  return result;
}

TEST(BiteAttempt, DrawsTheScopeBackWhereTheWayIsBlocked) {
  TraineeHand::Joints joints;
  const GoalResult blocked = attemptUnder(2 * Skill::expert().force_limit, joints);
  EXPECT_FALSE(blocked.reached);
  EXPECT_EQ(blocked.reason, "the way to the wall is blocked");
  EXPECT_EQ(joints[TipUpDown], 0);
  EXPECT_EQ(joints[TipLeftRight], 0);
  EXPECT_LE(joints[Insertion], 0.05);
}

TEST(BiteAttempt, GoesOnUnderAForceThatIsAllowed) {
  TraineeHand::Joints joints;
  const GoalResult result = attemptUnder(0.5 * Skill::expert().force_limit, joints);
  EXPECT_EQ(result.reason, "the helix got no hold of the wall") << "nothing is simulated";
  EXPECT_GT(joints[Insertion], 0.05);
}

}  // namespace
}  // namespace vibe::bite_attempt_test
