// What the actions of a trainee share.
#include "trainee/operator.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "onlooker.hpp"

namespace vibe::operator_test {
namespace {

/// Distances from the target of points that are aimed at in its stead [m].
std::vector<double> missesAt(double along, double aim_error) {
  Skill skill;
  skill.aim_error = aim_error;
  Onlooker at(skill);
  Operator& me = at.me;
  const WallPoint target = me.map().at(along, 0.3);
  std::vector<double> misses;
  for (int k = 0; k < 200; ++k) misses.push_back((me.position(me.withAimError(target)) - me.position(target)).norm());
  return misses;
}

// Two normal errors across each other: the mean square of the distance is 2 sigma^2.
TEST(Operator, AimsBesideTheTargetByItsAimError) {
  double square = 0;
  for (const double miss : missesAt(0.5, 2e-3)) square += miss * miss / 200;
  EXPECT_NEAR(std::sqrt(square / 2), 2e-3, 0.3e-3);
}

TEST(Operator, AimsAtTheTargetWhereTheErrorLeavesTheOrgan) {
  const std::vector<double> misses = missesAt(0.99, 20e-3);
  const auto on_target = std::count(misses.begin(), misses.end(), 0.0);
  EXPECT_GT(on_target, 20) << "beyond the end";
  EXPECT_LT(on_target, 180);
}

}  // namespace
}  // namespace vibe::operator_test
