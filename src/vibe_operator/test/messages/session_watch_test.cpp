#include "vibe_operator/messages/session_watch.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace vibe::operating::session_watch_test {
namespace {

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

TEST(SimulatorWatch, WaitsThenRunsThenIsGone) {
  SimulatorWatch watch;
  EXPECT_TRUE(contains(watch.problem("/procedure/state", 5), "Waiting for the simulator on /procedure/state"));
  watch.received(10);
  EXPECT_EQ(watch.problem("/procedure/state", 12.9), "");
  EXPECT_TRUE(contains(watch.problem("/procedure/state", 14), "gone"));
  EXPECT_TRUE(contains(watch.problem("/procedure/state", 14), "4 s"));
  watch.received(15);
  EXPECT_EQ(watch.problem("/procedure/state", 15), "");
  watch.forget();
  EXPECT_TRUE(contains(watch.problem("/procedure/state", 15), "Waiting"));
}

TEST(ControlWatch, RivalIsARecentPublisher) {
  ControlWatch watch;
  EXPECT_EQ(watch.rival(0), "");
  watch.received("/vibe_trainee", 10);
  EXPECT_EQ(watch.rival(11.9), "/vibe_trainee");
  EXPECT_EQ(watch.rival(12.1), "");
}

TEST(ControlWatch, SaysWhoHasControl) {
  ControlWatch watch;
  EXPECT_TRUE(contains(watch.sentence("/scope/buttons", false, 0, 0, 0), "Nobody has control"));
  EXPECT_TRUE(contains(watch.sentence("/scope/buttons", false, 1, 0, 0), "1 silent publisher"));
  EXPECT_TRUE(contains(watch.sentence("/scope/buttons", true, 0, 1, 0), "You have control"));
  EXPECT_TRUE(contains(watch.sentence("/scope/buttons", true, 0, 0, 0), "no simulator listens"));
  watch.received("/vibe_trainee", 10);
  EXPECT_TRUE(contains(watch.sentence("/scope/buttons", false, 1, 1, 10), "/vibe_trainee has control"));
  EXPECT_TRUE(contains(watch.sentence("/scope/buttons", true, 1, 1, 10), "is ignored"));
  EXPECT_FALSE(contains(watch.sentence("/scope/buttons", false, 1, 1, 13), "/vibe_trainee"));
}

TEST(MaxOfWindow, GivesTheLastWholeSecond) {
  MaxOfWindow window;
  EXPECT_TRUE(std::isnan(window.value(0)));
  for (int i = 0; i <= 10; ++i) window.add(i == 5 ? 0.08 : 0.01, 0.1 * i + 1e-9 * i);
  EXPECT_NEAR(window.value(1.0), 0.08, 1e-12);
  EXPECT_TRUE(std::isnan(window.value(5))) << "nothing came for a while";
  window.add(0.02, 5);
  EXPECT_TRUE(std::isnan(window.value(5))) << "no whole second before it";
}

TEST(Namespace, IsChecked) {
  for (const char* good : {"", "/", "/room1", "room1", "a/b"}) EXPECT_EQ(checkNamespace(good), "") << good;
  for (const char* bad : {"1room", "with space", "a-b", "\u00e4"}) EXPECT_NE(checkNamespace(bad), "") << bad;
}

}  // namespace
}  // namespace vibe::operating::session_watch_test
