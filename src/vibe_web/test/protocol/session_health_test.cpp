#include "protocol/session_health.hpp"

#include <gtest/gtest.h>

namespace vibe::web::session_health_test {
namespace {

SessionHealth well() {
  SessionHealth health;
  health.published = health.robot = health.base = true;
  return health;
}

TEST(SessionHealth, SaysNothingWhereAllIsWell) {
  EXPECT_EQ(noteOf(well()).text, "");
}

TEST(SessionHealth, ASilentSimulatorIsAnAlarmAlsoIfItWasPaused) {
  SessionHealth health = well();
  health.silence = 0.9 * kStale;
  EXPECT_EQ(noteOf(health).text, "");
  health.silence = 7;
  EXPECT_NE(noteOf(health).text.find("No states for more than 5 s"), std::string::npos);
  EXPECT_TRUE(noteOf(health).alarm);
  health.paused = true;
  EXPECT_TRUE(noteOf(health).alarm);
  health.silence = 1.1;  // it speaks once a second
  EXPECT_NE(noteOf(health).text.find("paused"), std::string::npos);
  EXPECT_FALSE(noteOf(health).alarm);
  health.published = false;  // it is gone, whatever it said before
  EXPECT_TRUE(noteOf(health).alarm);
}

TEST(SessionHealth, NamesWhatTheEndoscopeLacks) {
  SessionHealth health = well();
  health.base = false;
  EXPECT_NE(noteOf(health).text.find("/tf_static"), std::string::npos);
  health.robot = false;
  EXPECT_NE(noteOf(health).text.find("robot_description"), std::string::npos);
}

}  // namespace
}  // namespace vibe::web::session_health_test
