#include "vibe_graphics/geometry/mucosa_map.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "vibe_graphics/testing/tube_organ.hpp"

namespace vibe::graphics::fold_height_test {
namespace {

TEST(FoldHeightTest, FallsMonotonicallyAndIsGoneFromTheSmoothStretchOn) {
  float before = kTallestFold;
  for (float stretch = 0.8F; stretch < 1.3F; stretch += 0.002F) {
    const float height = foldHeight(stretch, 1.11F);
    EXPECT_LE(height, before) << stretch;
    if (stretch > 0.95F && stretch < 1.108F) {
      EXPECT_LT(height, before) << stretch;
    }
    before = height;
  }
  EXPECT_FLOAT_EQ(foldHeight(1, 1.11F), kRestingFold);
  EXPECT_EQ(foldHeight(1.1101F, 1.11F), 0);
  EXPECT_GT(foldHeight(1.109F, 1.11F), 0);  // control
}

// The spare length of a shallow wave, which the wall uses up: twice the height takes four times the stretch.
TEST(FoldHeightTest, SquareOfTheHeightIsProportionalToTheSpareLength) {
  const float half = foldHeight(1.11F - 0.11F / 4, 1.11F);
  EXPECT_NEAR(half, kRestingFold / 2, 1e-6F);
}

TEST(FoldHeightTest, StretchAroundFlattensThemAndStretchAlongDoesNot) {
  const test::TubeOrgan organ;
  const TissueMesh mesh = organ.mesh();
  FoldHeight folds(mesh, mapMucosa(mesh));
  const std::size_t middle = mesh.particle_count / 2;
  EXPECT_NEAR(folds.update(organ.places())[middle], kRestingFold, 1e-5F);
  const float wider = folds.update(organ.places(1.05))[middle];
  EXPECT_NEAR(folds.stretch()[middle], 1.05F, 2e-3F);
  EXPECT_NEAR(wider, foldHeight(1.05F, 1.111F), 1e-4F);
  EXPECT_NEAR(folds.update(organ.places(1, 1.05))[middle], kRestingFold, 1e-4F);  // control
  const std::vector<float>& smooth = folds.update(organ.places(1.2));
  EXPECT_EQ(*std::max_element(smooth.begin(), smooth.end()), 0);
  EXPECT_GT(folds.update(organ.places(0.95))[middle], kRestingFold);  // they come back
}

TEST(FoldHeightTest, IsTheSameForAnOrganThatIsMovedAsAWhole) {
  const test::TubeOrgan organ;
  const TissueMesh mesh = organ.mesh();
  FoldHeight folds(mesh, mapMucosa(mesh));
  const std::vector<float> still = folds.update(organ.places(1.03));
  std::vector<float> moved = organ.places(1.03);
  for (std::size_t k = 0; k < moved.size(); k += 3) {  // a quarter turn about z and a shift
    const float x = moved[k];
    moved[k] = 0.1F - moved[k + 1], moved[k + 1] = x, moved[k + 2] += 0.2F;
  }
  const std::vector<float>& there = folds.update(moved);
  for (std::size_t v = 0; v < still.size(); ++v) EXPECT_NEAR(there[v], still[v], 5e-6F) << v;
}

}  // namespace
}  // namespace vibe::graphics::fold_height_test
