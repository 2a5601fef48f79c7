#include "gradient/gradient_deformation.hpp"

#include <gtest/gtest.h>
#include "vibe_testing/allocation_count.hpp"

#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <limits>

#include "geometry/surface_operators.hpp"
#include "vibe_testing/expect_error.hpp"
#include "vibe_testing/worlds.hpp"

namespace vibe::prototype::gradient_deformation_test {
namespace {

using Eigen::Isometry3d;
using Eigen::Matrix3d;
using Eigen::Vector3d;

/// A surface with its positions in three arrays.
struct Shape {
  SurfaceMesh mesh;
  std::vector<double> x, y, z;
  explicit Shape(SurfaceMesh surface) : mesh(std::move(surface)) {
    for (const Vector3d& p : mesh.vertices) x.push_back(p.x()), y.push_back(p.y()), z.push_back(p.z());
  }
  SurfaceView view() const { return {mesh.triangles, x, y, z}; }
};

Shape ball() {
  return Shape(test::icosphere(0.05, 3));
}

/// Square of 40 mm in the plane z = 0, its inner nodes moved irregularly.
Shape sheet() {
  constexpr int kCells = 10;
  SurfaceMesh mesh;
  for (int i = 0; i <= kCells; ++i)
    for (int k = 0; k <= kCells; ++k) {
      const bool inner = i > 0 && k > 0 && i < kCells && k < kCells;
      const double shift = inner ? 0.0012 * std::sin(12.9898 * i + 78.233 * k) : 0;
      mesh.vertices.emplace_back(0.004 * i + shift, 0.004 * k - shift, 0);
    }
  const auto n = [&](int i, int k) { return i * (kCells + 1) + k; };
  for (int i = 0; i < kCells; ++i)
    for (int k = 0; k < kCells; ++k) {
      mesh.triangles.push_back({n(i, k), n(i + 1, k), n(i + 1, k + 1)});
      mesh.triangles.push_back({n(i, k), n(i + 1, k + 1), n(i, k + 1)});
    }
  return Shape(mesh);
}

/// All nodes; those on the border of the sheet.
std::vector<int> all(const Shape& shape) {
  std::vector<int> nodes(shape.x.size());
  for (std::size_t i = 0; i < nodes.size(); ++i) nodes[i] = static_cast<int>(i);
  return nodes;
}
std::vector<int> border(const Shape& shape) {
  std::vector<int> nodes;
  for (const int i : all(shape))
    if (shape.x[i] < 1e-9 || shape.y[i] < 1e-9 || shape.x[i] > 0.04 - 1e-9 || shape.y[i] > 0.04 - 1e-9)
      nodes.push_back(i);
  return nodes;
}

template <class Map>
std::vector<Vector3d> moved(const Shape& shape, const std::vector<int>& nodes, const Map& map) {
  std::vector<Vector3d> targets;
  for (const int node : nodes) targets.push_back(map(shape.view().position(node)));
  return targets;
}

/// Largest distance of the patch from where a map would have it [m].
template <class Map>
double farthestFrom(const Shape& shape, const std::vector<int>& patch, const std::vector<Vector3d>& positions,
                    const Map& map) {
  double worst = 0;
  for (std::size_t i = 0; i < patch.size(); ++i)
    worst = std::max(worst, (positions[i] - map(shape.view().position(patch[i]))).norm());
  return worst;
}

const auto kStay = [](const Vector3d& p) { return p; };

/// A disc around node 0 of the ball, pushed outwards.
struct Poke {
  Shape shape = ball();
  std::vector<int> disc = patchAround(shape.view(), {0}, 0.008);
  std::vector<int> patch = patchAround(shape.view(), disc, 0.03);
  Vector3d out = shape.view().position(0).normalized();

  std::vector<Vector3d> run(double distance, int turns) {
    GradientDeformation deformation(shape.view(), patch, disc, turns);
    std::vector<Vector3d> positions;
    deformation.deform(moved(shape, disc, [&](const Vector3d& p) { return p + distance * out; }), positions);
    return positions;
  }
};

TEST(GradientDeformation, LeavesAShapeThatNothingMoves) {
  const Shape shape = ball();
  const std::vector<int> patch = patchAround(shape.view(), {5}, 0.03);
  for (const int turns : {0, 1, 5}) {
    GradientDeformation deformation(shape.view(), patch, {5}, turns);
    std::vector<Vector3d> positions;
    deformation.deform({shape.view().position(5)}, positions);
    EXPECT_LT(farthestFrom(shape, patch, positions, kStay), 1e-14) << turns;
  }
}

TEST(GradientDeformation, ReproducesRigidMotions) {
  const Shape shape = ball();
  const std::vector<int> patch = patchAround(shape.view(), {5}, 0.03);
  const std::vector<int> rim = GradientDeformation(shape.view(), patch, {5}).rim();
  ASSERT_GT(rim.size(), 8u);
  ASSERT_LT(rim.size(), patch.size() / 2);
  const Isometry3d motion =
      Eigen::Translation3d(0.3, -0.1, 0.2) * Eigen::AngleAxisd(2.7, Vector3d(1, -2, 0.5).normalized());
  const auto map = [&](const Vector3d& p) { return Vector3d(motion * p); };
  for (const int turns : {0, 1, 5}) {
    GradientDeformation deformation(shape.view(), patch, rim, turns);
    std::vector<Vector3d> positions;
    deformation.deform(moved(shape, rim, map), positions);
    EXPECT_LT(farthestFrom(shape, patch, positions, map), 1e-13) << turns;
  }
}

TEST(GradientDeformation, ReproducesAffineMapsOfFlatPatches) {
  // the cotangent Laplacian is exact for linear functions whatever the triangles are
  const Shape shape = sheet();
  Matrix3d a;
  a << 1.4, 0.3, 0, 0.1, 0.8, 0, 0.2, -0.5, 1;
  const auto map = [&](const Vector3d& p) { return Vector3d(a * p + Vector3d(0.01, 0.02, 0.03)); };
  GradientDeformation deformation(shape.view(), all(shape), border(shape), 0);
  std::vector<Vector3d> positions;
  deformation.deform(moved(shape, border(shape), map), positions);
  EXPECT_LT(farthestFrom(shape, all(shape), positions, map), 1e-14);
  // the check can fail: a map that is not affine is not reproduced
  const auto bent = [&](const Vector3d& p) { return Vector3d(p + Vector3d(0, 0, 10 * p.x() * p.x())); };
  deformation.deform(moved(shape, border(shape), bent), positions);
  EXPECT_GT(farthestFrom(shape, all(shape), positions, bent), 1e-4);
}

TEST(GradientDeformation, HoldsRimAndHandles) {
  Poke poke;
  const auto positions = poke.run(0.010, 2);
  const auto rim = GradientDeformation(poke.shape.view(), poke.patch, poke.disc).rim();
  for (std::size_t i = 0; i < poke.patch.size(); ++i) {
    const Vector3d shift = positions[i] - poke.shape.view().position(poke.patch[i]);
    if (std::count(rim.begin(), rim.end(), poke.patch[i]) > 0) {
      EXPECT_EQ(shift.norm(), 0);
    }
    if (std::count(poke.disc.begin(), poke.disc.end(), poke.patch[i]) > 0) {
      EXPECT_LT((shift - 0.010 * poke.out).norm(), 1e-15);
    }
  }
}

TEST(GradientDeformation, FallsOffFromTheToolToTheRim) {
  Poke poke;
  const auto ways = edgeDistances(poke.shape.mesh, poke.disc);
  for (const int turns : {0, 2}) {
    const auto positions = poke.run(0.010, turns);
    double shift[4] = {};  // means over rings
    int count[4] = {};
    for (std::size_t i = 0; i < poke.patch.size(); ++i) {
      const double moved_by = (positions[i] - poke.shape.view().position(poke.patch[i])).norm();
      EXPECT_LT(moved_by, 0.0105) << "nothing moves farther than the tool";
      const int ring = std::min(3, static_cast<int>(ways[poke.patch[i]] / 0.0075));
      shift[ring] += moved_by;
      ++count[ring];
    }
    for (int ring = 1; ring < 4; ++ring)
      EXPECT_LT(shift[ring] / count[ring], 0.9 * shift[ring - 1] / count[ring - 1]) << turns;
    EXPECT_LT(shift[3] / count[3], 0.0015);
  }
}

/// The energy that turns lower: how far the sides are from the turned sides at the start, per node.
double distortion(const Shape& shape, const std::vector<int>& patch, const std::vector<Vector3d>& positions) {
  SurfaceMesh inside = shape.mesh;  // the triangles of the patch
  const auto leaves = [&](int node) { return !std::binary_search(patch.begin(), patch.end(), node); };
  inside.triangles.erase(std::remove_if(inside.triangles.begin(), inside.triangles.end(),
                                        [&](const auto& t) { return std::any_of(t.begin(), t.end(), leaves); }),
                         inside.triangles.end());
  const Eigen::SparseMatrix<double> stiffness = cotangentStiffness(inside);
  std::vector<Vector3d> now = shape.mesh.vertices;
  for (std::size_t i = 0; i < patch.size(); ++i) now[patch[i]] = positions[i];
  double energy = 0;
  for (int n = 0; n < static_cast<int>(now.size()); ++n) {
    Matrix3d sum = Matrix3d::Zero();
    const auto eachSide = [&](const auto& visit) {
      for (Eigen::SparseMatrix<double>::InnerIterator it(stiffness, n); it; ++it)
        if (it.row() != n) visit(-it.value(), static_cast<std::size_t>(it.row()));
    };
    eachSide([&](double w, std::size_t j) {
      sum += w * (now[n] - now[j]) * (shape.mesh.vertices[n] - shape.mesh.vertices[j]).transpose();
    });
    const Eigen::JacobiSVD<Matrix3d> svd(sum, Eigen::ComputeFullU | Eigen::ComputeFullV);
    Matrix3d sign = Matrix3d::Identity();
    sign(2, 2) = (svd.matrixU() * svd.matrixV().transpose()).determinant() < 0 ? -1 : 1;
    const Matrix3d turn = svd.matrixU() * sign * svd.matrixV().transpose();
    eachSide([&](double w, std::size_t j) {
      energy += w * ((now[n] - now[j]) - turn * (shape.mesh.vertices[n] - shape.mesh.vertices[j])).squaredNorm();
    });
  }
  return energy;
}

TEST(GradientDeformation, TurnsLowerTheDistortion) {
  Poke poke;
  double last = std::numeric_limits<double>::infinity();
  for (const int turns : {0, 1, 2, 5, 20}) {
    const double energy = distortion(poke.shape, poke.patch, poke.run(0.012, turns));
    EXPECT_LT(energy, last) << turns;
    last = energy;
  }
}

TEST(GradientDeformation, SeesTheSameFromEverywhere) {
  Poke poke, turned;
  const Isometry3d motion =
      Eigen::Translation3d(-0.2, 0.1, 0.4) * Eigen::AngleAxisd(1.3, Vector3d(0.2, 1, -2).normalized());
  for (std::size_t i = 0; i < turned.shape.x.size(); ++i) {
    const Vector3d p = motion * poke.shape.mesh.vertices[i];
    turned.shape.x[i] = p.x(), turned.shape.y[i] = p.y(), turned.shape.z[i] = p.z();
  }
  turned.out = motion.linear() * poke.out;
  const auto here = poke.run(0.008, 3), there = turned.run(0.008, 3);
  for (std::size_t i = 0; i < here.size(); ++i) EXPECT_LT((motion * here[i] - there[i]).norm(), 1e-12);
}

TEST(GradientDeformation, DependsOnItsArgumentsAlone) {
  Poke poke;
  GradientDeformation deformation(poke.shape.view(), poke.patch, poke.disc, 2);
  const auto targets = [&](double d) {
    return moved(poke.shape, poke.disc, [&](const Vector3d& p) { return p + d * poke.out; });
  };
  std::vector<Vector3d> first, between, again;
  deformation.deform(targets(0.010), first);
  deformation.deform(targets(-0.015), between);
  deformation.setHandles({poke.disc.front()});
  deformation.setHandles(poke.disc);
  deformation.deform(targets(0.010), again);
  EXPECT_TRUE(std::equal(first.begin(), first.end(), again.begin(), [](auto& a, auto& b) { return a == b; }));
  EXPECT_FALSE(std::equal(first.begin(), first.end(), between.begin(), [](auto& a, auto& b) { return a == b; }));
}

TEST(GradientDeformation, TakesThePatchInAnyOrder) {
  Poke poke;
  const auto forward = poke.run(0.010, 2);
  std::reverse(poke.patch.begin(), poke.patch.end());
  const auto backward = poke.run(0.010, 2);
  for (std::size_t i = 0; i < forward.size(); ++i)
    EXPECT_LT((forward[i] - backward[forward.size() - 1 - i]).norm(), 1e-12);
}

TEST(GradientDeformation, DoesNotAllocateAfterItsFirstUse) {
  if (!VIBE_COUNTS_ALLOCATIONS) GTEST_SKIP() << "a sanitizer brings its own memory";
  Poke poke;
  GradientDeformation deformation(poke.shape.view(), poke.patch, poke.disc, 2);
  auto targets = moved(poke.shape, poke.disc, kStay);
  std::vector<Vector3d> positions;
  deformation.deform(targets, positions);
  const long before = test::allocations;
  for (Vector3d& target : targets) target += 0.005 * poke.out;
  deformation.deform(targets, positions);
  EXPECT_EQ(test::allocations, before);
}

TEST(GradientDeformation, PatchesEndAtTheirRadius) {
  const Shape shape = ball();
  const auto ways = edgeDistances(shape.mesh, {3, 7});
  const auto patch = patchAround(shape.view(), {3, 7}, 0.02);
  std::vector<int> expected;
  for (const int node : all(shape))
    if (ways[node] <= 0.02) expected.push_back(node);
  EXPECT_EQ(patch, expected);
  EXPECT_TRUE(patchAround(shape.view(), {-1}, 0.02).empty());
  EXPECT_EQ(patchAround(shape.view(), {0}, 1.0).size(), shape.x.size());
}

TEST(GradientDeformation, SaysWhatIsWrong) {
  const Shape shape = ball();
  const std::vector<int> patch = patchAround(shape.view(), {5}, 0.03);
  EXPECT_ERROR(GradientDeformation(shape.view(), patch, {-1}), "handle -1 is not in the patch");
  EXPECT_ERROR(GradientDeformation(shape.view(), {1, 999999}, {1}), "node 999999");
  EXPECT_ERROR(GradientDeformation(shape.view(), all(shape), {}), "neither a rim nor a handle");
  EXPECT_ERROR(GradientDeformation(shape.view(), patch, {5}, -1), "turns");
  GradientDeformation deformation(shape.view(), patch, {5});
  std::vector<Vector3d> positions;
  EXPECT_ERROR(deformation.deform({}, positions), "0 targets for 1 handles");
  Shape flat = ball();
  for (const int node : flat.mesh.triangles[0]) flat.x[node] = flat.y[node] = flat.z[node] = 0.05;
  EXPECT_ERROR(GradientDeformation(flat.view(), all(flat), {5}), "no area");
  // two balls, the handle on one of them
  Shape two(test::icosphere(0.05, 1));
  const int count = static_cast<int>(two.x.size());
  for (int i = 0; i < count; ++i) two.x.push_back(two.x[i] + 1), two.y.push_back(two.y[i]), two.z.push_back(two.z[i]);
  const auto triangles = two.mesh.triangles;
  for (const auto& t : triangles) two.mesh.triangles.push_back({t[0] + count, t[1] + count, t[2] + count});
  EXPECT_ERROR(GradientDeformation(two.view(), all(two), {5}), "connected to no rim and no handle");
}

}  // namespace
}  // namespace vibe::prototype::gradient_deformation_test
