// The instrument of vibe_policy: a number that acts in a state changes its bits, one that does not act changes none.
#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <sstream>

#include "contact_scene.hpp"
#include "policy/policy_study.hpp"

namespace vibe::benchmarks::policy_test {
namespace {

const PolicyNumber& numberOf(const std::string& name) {
  const auto& numbers = policyNumbers();
  return *std::find_if(numbers.begin(), numbers.end(), [&](const PolicyNumber& number) { return number.name == name; });
}

bool acts(const PolicyEffect& effect, const std::string& state) {
  return std::find(effect.states.begin(), effect.states.end(), state) != effect.states.end();
}

TEST(Policy, EachNumberHasANameOfItsOwnAndAReason) {
  std::set<std::string> names;
  for (const PolicyNumber& number : policyNumbers()) {
    EXPECT_TRUE(names.insert(number.name).second) << number.name;
    EXPECT_TRUE(*number.section != 0 && *number.meaning != 0 && *number.reason != 0) << number.name;
  }
}

TEST(Policy, AShiftChangesWhatDependsOnIt) {
  std::ostringstream log;
  const PolicyStudy study(test::coarseStomach(), test::scopeUrdf(), log);
  EXPECT_GT(study.total().iterations, study.total().steps);

  const PolicyEffect stiffer = study.effectOf(numberOf("touch_confined"), 1.2);
  EXPECT_DOUBLE_EQ(stiffer.value, 1.2 * 17);
  EXPECT_TRUE(acts(stiffer, "pressed") && acts(stiffer, "rammed"));
  EXPECT_FALSE(acts(stiffer, "aimed"));
  EXPECT_GT(stiffer.force, 1e-4);
  EXPECT_GT(stiffer.motion_max, stiffer.motion_rms);
  EXPECT_DOUBLE_EQ(stepPolicy().touch_confined, 17) << "the policy is put back";

  const PolicyEffect aimed = study.effectOf(numberOf("ik_direction_weight"), 0.8);
  EXPECT_EQ(aimed.states, std::vector<std::string>{"aimed"});
  EXPECT_EQ(aimed.force, 0);

  const PolicyEffect cost = study.effectOf(numberOf("tree_leaf"), 1.2);
  EXPECT_DOUBLE_EQ(cost.value, 5);
  EXPECT_TRUE(cost.states.empty()) << "lists contain more or less than what counts";
  EXPECT_EQ(cost.motion_max, 0);
}

}  // namespace
}  // namespace vibe::benchmarks::policy_test
