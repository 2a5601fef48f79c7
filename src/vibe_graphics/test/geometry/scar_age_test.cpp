#include "vibe_graphics/geometry/argon_traces.hpp"

#include <gtest/gtest.h>

#include "vibe_graphics/testing/tube_organ.hpp"

namespace vibe::graphics::scar_age_test {
namespace {

constexpr std::size_t kFirst = 100, kLater = 2000, kBare = 3000;  // particles

TissueFrame frameAt(const TissueMesh& mesh, double time, std::uint8_t first, std::uint8_t later) {
  TissueFrame frame;
  frame.time = time;
  frame.grade.assign(mesh.particle_count, 0);
  frame.grade[kFirst] = first, frame.grade[kLater] = later;
  return frame;
}

TEST(ScarAgeTest, EachMarkAgesFromItsOwnTime) {
  const TissueMesh mesh = test::TubeOrgan().mesh();
  ScarAge ages(mesh);
  ages.see(frameAt(mesh, 0, 0, 0));
  ages.see(frameAt(mesh, 10, 1, 0));
  EXPECT_EQ(ages.browned()[kFirst], 0);
  ages.see(frameAt(mesh, 10 + kTanAge, 1, 1));
  EXPECT_EQ(ages.browned()[kFirst], 0.5F);
  EXPECT_EQ(ages.browned()[kLater], 0);
  ages.see(frameAt(mesh, 10 + 2 * kTanAge, 1, 1));
  EXPECT_EQ(ages.browned()[kFirst], 0.75F);
  EXPECT_EQ(ages.browned()[kLater], 0.5F);
  EXPECT_EQ(ages.browned()[kBare], 0);  // control
}

TEST(ScarAgeTest, DoesNotDependOnTheFramesBetween) {
  const TissueMesh mesh = test::TubeOrgan().mesh();
  ScarAge rare(mesh), often(mesh);
  for (const double time : {5.0, 400.0}) rare.see(frameAt(mesh, time, 1, 0));
  for (double time = 5; time <= 400; time += 0.5) often.see(frameAt(mesh, time, 1, 0));
  EXPECT_EQ(rare.browned(), often.browned());
  often.see(frameAt(mesh, 450, 1, 0));
  EXPECT_NE(rare.browned(), often.browned());  // control
}

TEST(ScarAgeTest, AHigherGradeIsNew) {
  const TissueMesh mesh = test::TubeOrgan().mesh();
  ScarAge ages(mesh);
  ages.see(frameAt(mesh, 0, 1, 1));
  ages.see(frameAt(mesh, kTanAge, 2, 1));
  EXPECT_EQ(ages.browned()[kFirst], 0);
  EXPECT_EQ(ages.browned()[kLater], 0.5F);
  ages.see(frameAt(mesh, 2 * kTanAge, 2, 1));
  EXPECT_EQ(ages.browned()[kFirst], 2 * 0.5F);  // times its grade
}

TEST(ScarAgeTest, AllIsNewWhenTimeOrGradesAreSetBack) {
  const TissueMesh mesh = test::TubeOrgan().mesh();
  const auto after = [&](const TissueFrame& last) {
    ScarAge ages(mesh);
    ages.see(frameAt(mesh, 0, 1, 1));
    ages.see(frameAt(mesh, 2 * kTanAge, 1, 1));
    ages.see(last);
    return ages.browned()[kFirst];
  };
  EXPECT_EQ(after(frameAt(mesh, 2 * kTanAge, 1, 1)), 0.75F);  // control
  EXPECT_EQ(after(frameAt(mesh, kTanAge, 1, 1)), 0);
  EXPECT_EQ(after(frameAt(mesh, 2 * kTanAge, 1, 0)), 0);
}

TEST(ScarAgeTest, TellsOnlyOfVisibleChanges) {
  const TissueMesh mesh = test::TubeOrgan().mesh();
  ScarAge ages(mesh);
  ages.see(frameAt(mesh, 0, 1, 0));
  int changes = 0;
  for (int k = 1; k <= 1000; ++k) changes += ages.see(frameAt(mesh, 0.01 * k, 1, 0)) ? 1 : 0;
  EXPECT_EQ(changes, 7);  // 10 s are 0.0285, and 7.3 steps of 1/256
}

// At the border of a mark its colour must not depend on the unmarked particles beside it.
TEST(ScarAgeTest, VertexOfARenderSurfaceHasTheBrowningOfItsMarkedParticles) {
  TissueMesh mesh = test::TubeOrgan().mesh();
  mesh.vertex_count = 2;
  mesh.render_offsets = {0, 3, 4};
  mesh.render_particles = {kFirst, kLater, kBare, kBare};
  mesh.render_weights = {0.2F, 0.3F, 0.5F, 1};
  ScarAge ages(mesh);
  ages.see(frameAt(mesh, 0, 1, 1));
  ages.see(frameAt(mesh, kTanAge, 1, 1));
  const std::vector<float> browned = ages.browned();
  ASSERT_EQ(browned.size(), 2u);
  const float grade = 0.2F + 0.3F;
  EXPECT_FLOAT_EQ(browned[0] / grade, 0.5F);
  EXPECT_EQ(browned[1], 0);
}

}  // namespace
}  // namespace vibe::graphics::scar_age_test
