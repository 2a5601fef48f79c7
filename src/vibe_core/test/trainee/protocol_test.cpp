// Protocols of goals: what they mean, and what is wrong with them.
#include "vibe_core/trainee/protocol.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "vibe_core/program/error.hpp"

namespace vibe::protocol_test {
namespace {

Protocol parse(const std::string& goals) {
  return Protocol::parse("name: test\n" + goals, "test.yaml");
}

std::string errorOf(const std::string& goals) {
  try {
    parse(goals);
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

TEST(Protocol, ReadsEveryGoal) {
  const Protocol protocol = parse(
      "seed: 7\nskill: novice\ngoals:\n"
      "  - insufflate: {patience: 40 s}\n"
      "  - mark: {along: 60 %, around: 90 deg, for: 3 s}\n"
      "  - bite: {along: 0.5, around: 0, distal: 10 mm, anterior: -5 mm}\n"
      "  - suture_set: {pattern: z, bites: 8, along: 0.4, length: 3 cm, width: 5 cm, mirrored: true, cinched: false}\n"
      "  - cinch\n"
      "  - wait: {for: 2 s}\n"
      "  - withdraw\n"
      "  - inspect: {along: 0.2, distance: 5 cm, for: 4 s}\n");
  EXPECT_EQ(protocol.seed, 7u);
  EXPECT_EQ(protocol.skill.name, "novice");
  ASSERT_EQ(protocol.goals.size(), 8u);
  EXPECT_EQ(std::get<InsufflateGoal>(protocol.goals[0]).patience, 40);
  const MarkGoal mark = std::get<MarkGoal>(protocol.goals[1]);
  EXPECT_DOUBLE_EQ(mark.place.along, 0.6);
  EXPECT_DOUBLE_EQ(mark.place.around, M_PI / 2);
  EXPECT_EQ(mark.time, 3);
  const BiteGoal bite = std::get<BiteGoal>(protocol.goals[2]);
  EXPECT_DOUBLE_EQ(bite.place.distal, 0.01);
  EXPECT_DOUBLE_EQ(bite.place.anterior, -0.005);
  const SutureSetGoal set = std::get<SutureSetGoal>(protocol.goals[3]);
  EXPECT_EQ(set.pattern, Technique::Z);
  EXPECT_EQ(set.bites, 8);
  EXPECT_DOUBLE_EQ(set.length, 0.03);
  EXPECT_DOUBLE_EQ(set.width, 0.05);
  EXPECT_TRUE(set.mirrored);
  EXPECT_FALSE(set.cinched);
  EXPECT_TRUE(std::holds_alternative<CinchGoal>(protocol.goals[4]));
  EXPECT_EQ(std::get<WaitGoal>(protocol.goals[5]).time, 2);
  EXPECT_TRUE(std::holds_alternative<WithdrawGoal>(protocol.goals[6]));
  const InspectGoal look = std::get<InspectGoal>(protocol.goals[7]);
  EXPECT_DOUBLE_EQ(look.place.along, 0.2);
  EXPECT_DOUBLE_EQ(look.distance, 0.05);
  EXPECT_EQ(look.time, 4);
}

TEST(Protocol, InspectLooksAtAPlaceOrAtSoMuchOfTheWall) {
  const Protocol protocol =
      parse("goals:\n  - inspect: {coverage: 80 %, region: antrum, patience: 60 s}\n  - inspect\n");
  const SurveyGoal survey = std::get<SurveyGoal>(protocol.goals[0]);
  EXPECT_DOUBLE_EQ(survey.coverage, 0.8);
  EXPECT_EQ(survey.region, Region::Antrum);
  EXPECT_EQ(survey.patience, 60);
  EXPECT_EQ(describe(protocol.goals[0]), "inspect 80 % of the antrum");
  EXPECT_TRUE(std::holds_alternative<InspectGoal>(protocol.goals[1]));
  EXPECT_NE(errorOf("goals:\n  - inspect: {coverage: 0.9, along: 0.2}\n").find("along: is not a known key"),
            std::string::npos);
  EXPECT_NE(errorOf("goals:\n  - inspect: {coverage: 120 %}\n").find("coverage"), std::string::npos);
}

TEST(Protocol, PlacesMayBeSharesOfARegion) {
  const Protocol protocol = parse(
      "goals:\n  - bite: {region: antrum, along: 20 %}\n  - sleeve: {sets: 2, region: body}\n  - marks: {region: "
      "fundus}\n"
      "  - bite: {along: 20 %}\n");
  EXPECT_EQ(std::get<BiteGoal>(protocol.goals[0]).place.region, Region::Antrum);
  EXPECT_EQ(describe(protocol.goals[0]), "bite at 20 % of the antrum, 0 deg");
  EXPECT_EQ(std::get<SutureSetGoal>(protocol.goals[2]).centre.region, Region::Body);
  EXPECT_EQ(std::get<MarkGoal>(protocol.goals[3]).place.region, Region::Fundus);
  EXPECT_FALSE(std::get<BiteGoal>(protocol.goals.back()).place.region);
  EXPECT_NE(errorOf("goals:\n  - bite: {region: bodi}\n").find("did you mean 'body'"), std::string::npos);
  EXPECT_NE(errorOf("goals: [insuflate]\n").find("'insuflate' is not a goal; did you mean 'insufflate'"),
            std::string::npos);
  EXPECT_NE(errorOf("actions: []\ngoals: [cinch]\n").find("keep one of the two"), std::string::npos);
  EXPECT_NE(errorOf("goals:\n  - cinch: {region: body}\n").find("region: is not a known key"), std::string::npos);
}

TEST(Protocol, ASleeveIsARowOfSets) {
  const Protocol protocol = parse("goals:\n  - sleeve: {sets: 3, from: 60 %, to: 20 %, bites: 5}\n");
  ASSERT_EQ(protocol.goals.size(), 3u);
  const double along[] = {0.6, 0.4, 0.2};
  for (int k = 0; k < 3; ++k) {
    const SutureSetGoal set = std::get<SutureSetGoal>(protocol.goals[k]);
    EXPECT_NEAR(set.centre.along, along[k], 1e-12);
    EXPECT_NEAR(set.spacing, 0.2, 1e-12);
    EXPECT_EQ(set.bites, 5);
  }
}

TEST(Protocol, MarksAreARow) {
  const Protocol protocol = parse("goals:\n  - marks: {count: 2, from: 60 %, to: 40 %, around: -60 deg, for: 3 s}\n");
  ASSERT_EQ(protocol.goals.size(), 2u);
  const MarkGoal last = std::get<MarkGoal>(protocol.goals[1]);
  EXPECT_DOUBLE_EQ(last.place.along, 0.4);
  EXPECT_DOUBLE_EQ(last.place.around, -M_PI / 3);
  EXPECT_EQ(last.time, 3);
}

TEST(Protocol, SkillsLieBetweenExpertAndNovice) {
  const Skill expert = Skill::expert(), novice = Skill::novice();
  const Skill half = parse("skill: {novice: 0.5}\ngoals: [withdraw]\n").skill;
  EXPECT_NEAR(half.aim_error, 0.5 * (expert.aim_error + novice.aim_error), 1e-12);
  const Skill own = parse("skill: {like: novice, aim_error: 2 mm, attempts: 5}\ngoals: [withdraw]\n").skill;
  EXPECT_DOUBLE_EQ(own.aim_error, 2e-3);
  EXPECT_EQ(own.attempts, 5);
  EXPECT_EQ(own.reaction_time, novice.reaction_time);
  EXPECT_EQ(parse("skill: {foresight: 50 %}\ngoals: [withdraw]\n").skill.foresight, 0.5);
}

TEST(Protocol, ShippedOnesAreReadAndEndWithdrawn) {
  for (const std::string name : {"first", "expert", "novice"}) {
    const std::string file = std::string(VIBE_CORE_DIR) + "/trainees/" + name + ".yaml";
    ASSERT_TRUE(isProtocol(file)) << name;
    const Protocol protocol = Protocol::load(file);
    EXPECT_EQ(protocol.name, name);
    EXPECT_TRUE(std::holds_alternative<WithdrawGoal>(protocol.goals.back())) << name;
  }
  EXPECT_FALSE(isProtocol(std::string(VIBE_CORE_DIR) + "/trainees/demo/grabs.yaml"));
}

TEST(Protocol, EveryMistakeIsNamedWithItsPlaceAndRemedy) {
  const auto expect = [](const std::string& goals, const std::string& part) {
    EXPECT_NE(errorOf(goals).find(part), std::string::npos) << errorOf(goals);
    EXPECT_NE(errorOf(goals).find("test.yaml"), std::string::npos) << errorOf(goals);
  };
  expect("goals:\n  - suture_sets: {}\n", "suture_set");
  expect("goals:\n  - bite: {allong: 0.5}\n", "along");
  expect("goals:\n  - bite: {along: 1.5}\n", "along");
  expect("goals:\n  - bite: {along: 5 mm}\n", "along");
  expect("goals:\n  - suture_set: {pattern: w}\n", "pattern");
  expect("goals:\n  - suture_set: {pattern: square, bites: 4}\n", "does not exist");
  expect("goals:\n  - marks: {along: 0.5}\n", "along");
  expect("goals:\n  - cinch: {tension: 3 N}\n", "has none");
  expect("goals:\n  - {insufflate: {}, withdraw: {}}\n", "second goal");
  expect("goals: []\n", "no goals");
  expect("skill: clumsy\ngoals: [withdraw]\n", "novice");
  expect("skill: {aim: 1 mm}\ngoals: [withdraw]\n", "aim_error");
  expect("skill: {foresight: 1 mm}\ngoals: [withdraw]\n", "a pure number");
  expect("skill: {like: novice, novice: 0.5}\ngoals: [withdraw]\n", "one of them");
  EXPECT_NE(errorOf("goals:\n  - bite: {along: .nan}\n"), "no error");
}

}  // namespace
}  // namespace vibe::protocol_test
