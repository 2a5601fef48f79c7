#include "vibe_core/metrics/surface_section.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "geometry/test_surfaces.hpp"
#include "vibe_core/program/error.hpp"
#include "vibe_testing/worlds.hpp"

namespace vibe::surface_section_test {
namespace {

using test::icosphere;
using test::join;
using test::makeBox;
using test::makeTorus;

struct Cut {
  std::vector<SurfaceSection::Loop> loops;

  /// The label of a vertex is its y.
  Cut(const SurfaceMesh& mesh, const Eigen::Vector3d& point, const Eigen::Vector3d& normal) {
    std::vector<double> x, y, z;
    for (const auto& p : mesh.vertices) {
      x.push_back(p.x());
      y.push_back(p.y());
      z.push_back(p.z());
    }
    loops = SurfaceSection(mesh).cut(x, y, z, point, normal.normalized(), y);
  }
};

TEST(SurfaceSection, ofASphereIsADiscWhateverTheDirection) {
  const SurfaceMesh sphere = icosphere(0.05, 5);
  for (const Eigen::Vector3d& normal : {Eigen::Vector3d(0, 0, 1), Eigen::Vector3d(1, -2, 0.5)})
    for (double height : {-0.03, 0.0, 0.02, 0.045}) {
      const Cut cut(sphere, height * normal.normalized(), normal);
      ASSERT_EQ(cut.loops.size(), 1u);
      EXPECT_NEAR(cut.loops[0].area, M_PI * (0.05 * 0.05 - height * height), 1e-5);
    }
  EXPECT_TRUE(Cut(sphere, {0, 0, 0.06}, {0, 0, 1}).loops.empty());
}

TEST(SurfaceSection, ofABoxIsExactAlsoThroughVertices) {
  const SurfaceMesh box = makeBox(0.2, 0.3, 0.4);
  EXPECT_NEAR(Cut(box, {0, 0, 0.1}, {0, 0, 1}).loops.at(0).area, 0.06, 1e-15);
  EXPECT_NEAR(Cut(box, {0, 0, 0}, {0, 1, 1}).loops.at(0).area, 0.06 * std::sqrt(2), 1e-15);
  EXPECT_NEAR(Cut(box, {0, 0, 0}, {0, 0.4, 0.3}).loops.at(0).area, 0.1, 1e-15) << "from edge to edge";
  EXPECT_NEAR(Cut(box, {0, 0, 0}, {0, 0.4, -0.3}).loops.at(0).area, 0.1, 1e-15);
  EXPECT_NEAR(Cut(box, {0, 0, 0}, {0.3, 0.2, 0}).loops.at(0).area, 0.4 * std::hypot(0.2, 0.3), 1e-15) << "diagonal";
  EXPECT_NEAR(Cut(box, {0, 0, 0.2}, {0, 0, 1}).loops.at(0).area, 0.06, 1e-15) << "in a face counts as just inside";
}

TEST(SurfaceSection, tellsLoopsApart) {
  const SurfaceMesh torus = makeTorus(0.1, 0.02, 200, 100);
  const Cut cut(torus, {0, 0, 0}, {1, 0, 0});
  ASSERT_EQ(cut.loops.size(), 2u);
  for (const auto& loop : cut.loops) {
    EXPECT_NEAR(loop.area, M_PI * 4e-4, 1e-6);
    EXPECT_NEAR(std::abs(loop.label), 0.1, 2e-3);
  }
  EXPECT_LT(cut.loops[0].label * cut.loops[1].label, 0);
}

TEST(SurfaceSection, meansOnlyTheLabelsThereAre) {
  const SurfaceMesh box = makeBox(0.2, 0.3, 0.4);
  const double none = std::numeric_limits<double>::quiet_NaN();
  const auto labelOf = [&](const std::vector<double>& label) {
    std::vector<double> x, y, z;
    for (const auto& p : box.vertices) {
      x.push_back(p.x());
      y.push_back(p.y());
      z.push_back(p.z());
    }
    return SurfaceSection(box).cut(x, y, z, {0, 0, 0}, {0, 0, 1}, label).at(0).label;
  };
  EXPECT_DOUBLE_EQ(labelOf({3, 3, 3, none, none, 3, 3, 3}), 3);
  EXPECT_TRUE(std::isnan(labelOf(std::vector<double>(8, none))));
}

TEST(SurfaceSection, countsAHoleAsNegative) {
  SurfaceMesh inner = icosphere(0.02, 4);
  for (auto& t : inner.triangles) std::swap(t[1], t[2]);  // its outside is the cavity
  const Cut cut(join(icosphere(0.05, 4), inner, Eigen::Vector3d(0.01, 0, 0)), {0, 0, 0}, {0, 0, 1});
  ASSERT_EQ(cut.loops.size(), 2u);
  EXPECT_NEAR(cut.loops[0].area + cut.loops[1].area, M_PI * (25e-4 - 4e-4), 3e-5);
  EXPECT_LT(std::min(cut.loops[0].area, cut.loops[1].area), 0);
}

TEST(SurfaceSection, refusesAnOpenSurface) {
  SurfaceMesh open = icosphere(0.05, 1);
  open.triangles.pop_back();
  EXPECT_THROW(SurfaceSection{open}, Error);
}

}  // namespace
}  // namespace vibe::surface_section_test
