// When a trainee lets go of the cinch: at full tension, or where the tension has risen for the last time.
#include <gtest/gtest.h>

#include <algorithm>

#include "onlooker.hpp"

namespace vibe::cinch_action_test {
namespace {

struct Cinched {
  GoalResult result;
  double pulled;  // how long the cinch was pressed [s]
};

/// @param tension  of the thread over the time since the cinch was pressed [N]
Cinched cinchWith(const std::function<double(double)>& tension) {
  double since = -1;
  Onlooker* self = nullptr;
  Onlooker at(Skill::expert(), [&](Observation& seen) {
    seen.events = {Event{}};
    seen.events[0].kind = Event::Kind::TTagDropped;
    const bool pressed = self != nullptr && self->hand.command().buttons[Cinch];
    if (pressed && since < 0) since = seen.time;
    if (pressed) seen.tension = tension(seen.time - since);
  });
  self = &at;
  at.seen.tension = 0;
  const GoalResult result = perform(CinchGoal{}, at.me);
  return {result, at.seen.time - 0.5 - since};
}

TEST(Cinch, EndsAtFullTension) {
  const Cinched cinched = cinchWith([](double t) { return 0.4 * t; });
  EXPECT_TRUE(cinched.result.reached) << cinched.result.reason;
  EXPECT_NEAR(cinched.pulled, 3 / 0.4, 0.1) << "3 N";
}

TEST(Cinch, EndsWhereTheBitesHaveMet) {
  const Cinched cinched = cinchWith([](double t) { return std::min(0.4 * t, 2.4); });
  EXPECT_TRUE(cinched.result.reached) << cinched.result.reason;
  EXPECT_NEAR(cinched.pulled, 2.4 / 0.4 + 2, 0.3) << "two seconds without a rise";
}

TEST(Cinch, ASlowRiseIsARise) {
  const Cinched cinched = cinchWith([](double t) { return 1 + 0.1 * t; });
  EXPECT_TRUE(cinched.result.reached) << cinched.result.reason;
  EXPECT_NEAR(cinched.pulled, 20, 0.6);
}

TEST(Cinch, AThreadThatStaysLooseIsAReason) {
  const Cinched cinched = cinchWith([](double t) { return std::min(0.4 * t, 0.4); });
  EXPECT_FALSE(cinched.result.reached);
  EXPECT_NE(cinched.result.reason.find("did not become tight"), std::string::npos) << cinched.result.reason;
}

}  // namespace
}  // namespace vibe::cinch_action_test
