#include "vibe_core/metrics/session_outcome.hpp"

#include <gtest/gtest.h>
#include <yaml-cpp/yaml.h>

#include <cstdlib>
#include <limits>

namespace vibe::session_outcome_test {
namespace {

SessionOutcome outcome() {
  SessionOutcome result;
  result.measures = {{"max_force", "N", 0.1 + 0.2}, {"economy", "1", std::nullopt}, {"volume", "m^3", 1.25e-3}};
  std::vector<Event> events(3);
  events[0].kind = events[1].kind = Event::Kind::Grab;
  events[2].kind = Event::Kind::TTagDropped;
  result.events.record(events);
  result.goals = {{"mark at 50 %", true, ""}, {"bite", false, "the \"wall\" \\ was\n\tout of reach"}};
  result.steps = 7307;
  result.state_hash = 0x1f6dad6d7aa7616b;
  return result;
}

// JSON is YAML.
TEST(SessionOutcome, readsBackAsItWas) {
  const YAML::Node json = YAML::Load(toJson(outcome()));
  const YAML::Node force = json["measures"]["max_force"];
  EXPECT_EQ(force["unit"].as<std::string>(), "N");
  EXPECT_EQ(std::strtod(force["value"].as<std::string>().c_str(), nullptr), 0.1 + 0.2);  // to the bit
  EXPECT_TRUE(json["measures"]["economy"]["value"].IsNull());
  EXPECT_EQ(json["steps"].as<int>(), 7307);
  EXPECT_EQ(json["state_hash"].as<std::string>(), "1f6dad6d7aa7616b");
}

TEST(SessionOutcome, whatIsNotANumberIsNullAndWhatIsNotUtf8IsReplaced) {
  SessionOutcome odd = outcome();
  odd.measures = {{"a", "m", std::numeric_limits<double>::quiet_NaN()},
                  {"b", "m", std::numeric_limits<double>::infinity()}};
  odd.goals[0].goal = "\xff";
  const YAML::Node json = YAML::Load(toJson(odd));
  EXPECT_TRUE(json["measures"]["a"]["value"].IsNull());
  EXPECT_TRUE(json["measures"]["b"]["value"].IsNull());
  EXPECT_EQ(json["goals"][0]["goal"].as<std::string>(), "\xef\xbf\xbd");
}

TEST(SessionOutcome, countsEveryKindOfEvent) {
  const YAML::Node events = YAML::Load(toJson(outcome()))["events"];
  EXPECT_EQ(events.size(), static_cast<std::size_t>(kEventKindCount));
  EXPECT_EQ(events["grab"].as<int>(), 2);
  EXPECT_EQ(events["t-tag dropped"].as<int>(), 1);
  EXPECT_EQ(events["bite missed"].as<int>(), 0);
}

TEST(SessionOutcome, saysWhatBecameOfTheGoals) {
  const YAML::Node goals = YAML::Load(toJson(outcome()))["goals"];
  ASSERT_EQ(goals.size(), 2U);
  EXPECT_TRUE(goals[0]["reached"].as<bool>());
  EXPECT_FALSE(goals[1]["reached"].as<bool>());
  EXPECT_EQ(goals[1]["reason"].as<std::string>(), outcome().goals[1].reason);
}

TEST(SessionOutcome, ofNothingIsJsonToo) {
  const YAML::Node json = YAML::Load(toJson(SessionOutcome()));
  EXPECT_EQ(json["measures"].size(), 0U);
  EXPECT_EQ(json["goals"].size(), 0U);
}

}  // namespace
}  // namespace vibe::session_outcome_test
