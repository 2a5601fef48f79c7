// The words that this package adds to scenes.
#include <gtest/gtest.h>

#include "groups/group_cinch.hpp"
#include "vibe_core/constraints/constraint_registry.hpp"
#include "vibe_core/scene/scene_parser.hpp"
#include "vibe_core/scene/words.hpp"
#include "vibe_testing/expect_error.hpp"

namespace vibe::prototype::words_test {
namespace {

TEST(Words, ScenesMayNameTheWaysOfThePrototype) {
  const Scene scene = parseScene(
      "scope: {}\nhelix: {}\nsuture: {cinch_model: groups, classifier: printed}\nmarking: {deformation: gradient}",
      "s.yaml");
  EXPECT_EQ(scene.suture->cinch_model, "groups");
  EXPECT_EQ(scene.marking->deformation, "gradient");
  EXPECT_EQ(constraintNames().back(), "group");
}

TEST(Words, AreNoLongerMissing) {
  for (const char* key : {"suture.cinch_model", "marking.deformation"}) {
    EXPECT_TRUE(choicesNotLoaded(key).empty()) << key;
    EXPECT_EQ(choicesOf(key).size(), 2u) << key;
  }
  EXPECT_ERROR(registerCinchModel("groups", "", std::make_shared<GroupCinch>()), "exists already");
}

}  // namespace
}  // namespace vibe::prototype::words_test
