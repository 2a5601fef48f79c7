#include "vibe_operator/messages/table_rows.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace vibe::operating::suture_rows_test {
namespace {

vibe_msgs::SutureArray oneSet(std::uint8_t stage) {
  vibe_msgs::SutureArray sutures;
  sutures.sutures.resize(1);
  vibe_msgs::Suture& suture = sutures.sutures[0];
  suture.stage = stage;
  suture.bites.resize(7);
  suture.tension = {0, 2.46, 1};
  return sutures;
}

TEST(SutureRows, OpenSet) {
  const auto rows = sutureRows(oneSet(vibe_msgs::Suture::OPEN));
  ASSERT_EQ(rows.size(), 1u);
  EXPECT_EQ(rows[0].set, "1");
  EXPECT_EQ(rows[0].bites, "7");
  EXPECT_EQ(rows[0].stage, "open");
  EXPECT_EQ(rows[0].technique, "\u2013");
  EXPECT_EQ(rows[0].tension, "2.5");
  EXPECT_FALSE(rows[0].warns);
}

TEST(SutureRows, CinchedSetHasATechnique) {
  auto sutures = oneSet(vibe_msgs::Suture::CINCHED);
  sutures.sutures[0].technique_name = "u";
  sutures.sutures[0].technique_margin = 0.834;
  sutures.sutures[0].end = 60;
  sutures.sutures[0].pulled = 0.12;
  auto rows = sutureRows(sutures);
  EXPECT_EQ(rows[0].technique, "U 83%");
  EXPECT_EQ(rows[0].stage, "cinched");
  EXPECT_FALSE(rows[0].warns);
  EXPECT_NE(rows[0].help.find("120 mm"), std::string::npos);
  sutures.sutures[0].technique_name = "running";
  EXPECT_EQ(sutureRows(sutures)[0].technique, "running 83%");
}

TEST(SutureRows, PlannedAndRecognisedByBothRules) {
  auto sutures = oneSet(vibe_msgs::Suture::CINCHED);
  sutures.sutures.push_back(sutures.sutures[0]);
  vibe_msgs::Suture& suture = sutures.sutures[1];
  suture.technique_name = suture.corrected_technique_name = "triangular";
  suture.printed_technique_name = "z";
  vibe_msgs::TraineeProgress progress;
  for (const int number : {-1, 1, 1}) {
    vibe_msgs::GoalProgress& goal = progress.goals.emplace_back();
    goal.suture = number;
    goal.pattern = number < 0 ? "c" : "u";
  }
  const auto rows = sutureRows(sutures, &progress);
  EXPECT_EQ(rows[0].planned, "\u2013");
  EXPECT_EQ(rows[0].printed, "\u2013") << "not recognised yet";
  EXPECT_FALSE(rows[0].warns);
  EXPECT_EQ(rows[1].planned, "U");
  EXPECT_EQ(rows[1].technique, "triangular 0%");
  EXPECT_EQ(rows[1].printed, "Z");
  EXPECT_TRUE(rows[1].warns) << "another technique than planned";
  for (const char* word : {"corrected rule triangular", "printed in the paper Z", "Planned: U"})
    EXPECT_NE(rows[1].help.find(word), std::string::npos) << rows[1].help;
  progress.goals[2].pattern = "triangular";  // the last goal counts
  EXPECT_FALSE(sutureRows(sutures, &progress)[1].warns);
  EXPECT_EQ(sutureRows(sutures)[1].planned, "\u2013") << "without a trainee";
}

TEST(SutureRows, FaultsWarn) {
  auto sutures = oneSet(vibe_msgs::Suture::CINCHED);
  sutures.sutures[0].loose = true;
  EXPECT_EQ(sutureRows(sutures)[0].stage, "loose");
  EXPECT_TRUE(sutureRows(sutures)[0].warns);
  EXPECT_TRUE(sutureRows(oneSet(vibe_msgs::Suture::BROKEN))[0].warns);
  auto torn = oneSet(vibe_msgs::Suture::OPEN);
  torn.sutures[0].tear_outs = 2;
  EXPECT_TRUE(sutureRows(torn)[0].warns);
  EXPECT_EQ(sutureRows(torn)[0].bites, "7 (-2)");
}

TEST(SutureRows, TensionThatIsNotFiniteIsADash) {
  auto sutures = oneSet(vibe_msgs::Suture::TAGGED);
  sutures.sutures[0].tension[0] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(sutureRows(sutures)[0].tension, "\u2013");
  sutures.sutures[0].tension.clear();
  EXPECT_TRUE(std::isnan(maxTension(sutures.sutures[0])));
}

TEST(SutureRows, UnknownStageIsANumber) {
  EXPECT_EQ(sutureRows(oneSet(77))[0].stage, "stage 77");
  EXPECT_TRUE(sutureRows({}).empty());
}

}  // namespace
}  // namespace vibe::operating::suture_rows_test
