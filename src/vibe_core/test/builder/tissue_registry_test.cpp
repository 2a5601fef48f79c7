#include "vibe_core/builder/tissue_registry.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "vibe_core/builder/model_builder.hpp"
#include "vibe_core/scene/scene_parser.hpp"
#include "vibe_core/scene/words.hpp"
#include "vibe_testing/expect_error.hpp"

namespace vibe::tissue_registry_test {
namespace {

Scene sphere(const std::string& tissue) {
  return parseScene("geometry: {kind: sphere, particles: 200}\ntissue: {" + tissue + "}\n", "s.yaml");
}

/// What is registered below: a shell that says how often it was built.
TissueAndSolver countedShell(const TissueRequest& request, int& count) {
  ++count;
  Scene scene = request.scene;
  scene.tissue.model = "shell";
  return makeTissue(scene, request.organ, request.masses, request.areas, request.min_substeps);
}

TEST(TissueRegistry, RegisteredModelsAreReadBuiltAndSuggested) {
  int count = 0;
  EXPECT_ERROR(sphere("model: counted_shell"), "s.yaml:2: tissue.model: 'counted_shell' is not known here");
  registerTissueModel("counted_shell", "a shell", [&](const TissueRequest& r) { return countedShell(r, count); });
  const auto model = buildModel(sphere("model: counted_shell"), "");
  EXPECT_EQ(count, 1);
  EXPECT_EQ(model->tissue->name(), "shell");
  EXPECT_EQ(model->scene.tissue.model, "counted_shell");
  EXPECT_ERROR(sphere("model: counted_shel"), "did you mean 'counted_shell'?");
  EXPECT_ERROR(registerTissueModel("shell", "", [&](const TissueRequest& r) { return countedShell(r, count); }),
               "exists already");
  EXPECT_ERROR(registerTissueModel("empty", "", nullptr), "there is no factory");
  buildModel(sphere("model: shell"), "");  // control: another word calls another factory
  EXPECT_EQ(count, 1);
}

TEST(TissueRegistry, EveryWordHasAFactory) {
  for (const std::string name : {"shell", "shape_matching"}) {
    const auto names = tissueModelNames();
    EXPECT_NE(std::find(names.begin(), names.end(), name), names.end());
    EXPECT_EQ(buildModel(sphere("model: " + name), "")->tissue->name(), name);
  }
}

// Scenes made in code do not pass the parser.
TEST(TissueRegistry, UnknownNamesInCodeNameTheNearest) {
  Scene scene = sphere("");
  scene.tissue.model = "shel";
  EXPECT_ERROR(buildModel(scene, ""), "tissue.model 'shel' is unknown; did you mean 'shell'?");
  scene.tissue.model = "shell";
  scene.tissue.law = "yeho";
  EXPECT_ERROR(buildModel(scene, ""), "tissue.law 'yeho' is unknown; did you mean 'yeoh'?");
}

TEST(TissueRegistry, TheSceneOfAModelIsWhatTheUserWrote) {
  const auto open = buildModel(sphere("model: shape_matching"), "");
  EXPECT_EQ(open->scene.tissue.substeps, 0);
  EXPECT_GT(open->substeps, 1);
  const auto asked = buildModel(sphere("model: shape_matching, substeps: 77"), "");
  EXPECT_EQ(asked->scene.tissue.substeps, 77);
  EXPECT_EQ(asked->substeps, 77);
  EXPECT_EQ(buildModel(sphere("model: shell, substeps: 77"), "")->substeps, 0);  // it takes none
}

}  // namespace
}  // namespace vibe::tissue_registry_test
