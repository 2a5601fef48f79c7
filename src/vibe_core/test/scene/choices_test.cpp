#include "vibe_core/scene/choices.hpp"

#include <gtest/gtest.h>

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
  EXPECT_ERROR(addChoice("suture.cinch_model", {"rope", ""}), "takes no words of other packages");
}

}  // namespace
}  // namespace vibe::choices_test
