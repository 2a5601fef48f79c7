#include "vibe_core/scene/words.hpp"

#include <gtest/gtest.h>

#include "vibe_core/procedure/procedure_registry.hpp"
#include "vibe_core/scene/scene_parser.hpp"
#include "vibe_core/scene/schema.hpp"
#include "vibe_testing/expect_error.hpp"

namespace vibe::choices_test {
namespace {

TEST(Choices, TyposAreAnsweredWithLineAndNearestWord) {
  EXPECT_EQ(errorOf([] { parseScene("name: x\ntissue:\n  law: yeho\n", "s.yaml"); }),
            "s.yaml:3: tissue.law: 'yeho' is not known here; did you mean 'yeoh'?");
  EXPECT_EQ(errorOf([] { parseScene("name: x\ntissue:\n  model: shel\n", "s.yaml"); }),
            "s.yaml:3: tissue.model: 'shel' is not known here; did you mean 'shell'?");
  EXPECT_ERROR(parseScene("tissue: {law: xyz}", "s.yaml"), "known are neo_hookean, stable_neo_hookean, ");
}

TEST(Choices, AddedWordsAreReadSuggestedAndDocumented) {
  EXPECT_ERROR(parseScene("tissue: {law: added_word}", "s.yaml"), "is not known here");
  addChoice("tissue.law", {"added_word", "a formula"});
  EXPECT_EQ(parseScene("tissue: {law: added_word}", "s.yaml").tissue.law, "added_word");
  EXPECT_ERROR(parseScene("tissue: {law: added_wrod}", "s.yaml"), "did you mean 'added_word'?");
  EXPECT_NE(describeSchema().find("| `added_word` | a formula |"), std::string::npos);
}

TEST(Choices, UnusableWordsAreRejected) {
  EXPECT_ERROR(addChoice("tissue.law", {"yeoh", ""}), "tissue.law: 'yeoh' exists already");
  EXPECT_ERROR(addChoice("tissue.law", {"My Law", ""}), "use small letters");
  EXPECT_ERROR(addChoice("tissue.law", {"", ""}), "use small letters");
  EXPECT_ERROR(addChoice("suture.classifier", {"rope", ""}), "takes no words of other packages");
}

const char kGroups[] =
    "suture.cinch_model: 'groups' is in the package vibe_prototype, which this program has not loaded; build it and "
    "set "
    "the environment variable VIBE_PLUGINS=libvibe_prototype.so";

TEST(Choices, AWordOfAPackageThatIsNotLoadedSaysHowToLoadIt) {
  const auto suture = [](const std::string& word) {
    return parseScene("scope: {}\nhelix: {}\nsuture: {cinch_model: " + word + "}", "s.yaml");
  };
  EXPECT_EQ(errorOf([&] { suture("groups"); }), std::string("s.yaml:3: ") + kGroups);
  EXPECT_EQ(errorOf([] { findCinchModel("groups"); }), kGroups) << "a scene that no file tells";
  EXPECT_ERROR(suture("group"), "did you mean 'groups'?");
  EXPECT_ERROR(parseScene("scope: {}\nmarking: {deformation: gradient}", "s.yaml"), "s.yaml:2: marking.deformation: ");
  EXPECT_NE(describeSchema().find("needs the package `vibe_prototype`"), std::string::npos);
}

struct Rope : CinchModel {
  void begin(const Model&, const State&, Suture&) const override {}
  double draw(const Model&, const State&, double amount, Suture&) const override { return amount; }
  void slacken(const State&, Suture&) const override {}
};

TEST(Choices, WaysOfTheProcedureAreRegisteredOnce) {
  const auto rope = std::make_shared<Rope>();
  EXPECT_ERROR(findCinchModel("rope"), "'rope' is not known here");
  registerCinchModel("rope", "of a test", rope);
  EXPECT_EQ(findCinchModel("rope"), rope);
  EXPECT_EQ(findCinchModel("thread"), nullptr) << "the library's own";
  EXPECT_ERROR(registerCinchModel("rope", "", rope), "exists already");
  EXPECT_ERROR(registerCinchModel("none", "", nullptr), "suture.cinch_model: nothing is behind 'none'");
  EXPECT_ERROR(registerMarkingDeformation("solver", "", [](const Model&) { return nullptr; }), "exists already");
  EXPECT_ERROR(registerMarkingDeformation("none", "", {}), "marking.deformation: nothing is behind 'none'");
}

}  // namespace
}  // namespace vibe::choices_test
