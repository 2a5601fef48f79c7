// Places of two walls that a vertex and its nearest triangle do not see: edges that cross.
#include "self_contact/self_contact_close.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <random>
#include <set>
#include <utility>

#include "geometry/triangle_distance.hpp"
#include "self_contact/self_contact_worlds.hpp"
#include "vibe_core/solver/implicit_stepper.hpp"
#include "vibe_core/threads/thread_pool.hpp"
#include "vibe_core/tissue/shell.hpp"

namespace vibe::self_contact_close_test {
namespace {

using namespace test;

/// Two roofs whose ridges cross in the middle: one with its ridge along y, and one upside down above it, along x.
SurfaceMesh roofs(double gap) {
  constexpr double kHalf = 2.5e-3, kDown = 4e-3;
  SurfaceMesh mesh;
  mesh.vertices = {{0, -kHalf, 0},   {0, kHalf, 0},   {-kHalf, 0, -kDown},      {kHalf, 0, -kDown},
                   {-kHalf, 0, gap}, {kHalf, 0, gap}, {0, -kHalf, gap + kDown}, {0, kHalf, gap + kDown}};
  mesh.triangles = {{0, 1, 2}, {1, 0, 3}, {4, 5, 6}, {5, 4, 7}};
  for (auto& t : mesh.triangles) std::swap(t[1], t[2]);
  return mesh;
}

TEST(SelfContactClose, EdgesThatCrossPushEachOtherApart) {
  ContactWorld world(roofs(20e-3));
  for (std::size_t i = 4; i < 8; ++i)
    world.set(i, world.rest.vertices[i] - Eigen::Vector3d(0, 0, 20e-3 - 0.2 * kWallThickness));
  world.detect(0.5e-3);
  ASSERT_GT(world.evaluate(), 0);
  const Eigen::Vector3d up = world.totalForce(4, 8), down = world.totalForce(0, 4);
  EXPECT_GT(up.z(), 0.05);
  EXPECT_NEAR((up + down).norm(), 0, 1e-6 * up.norm());
  EXPECT_GT(world.force(4).z(), 0.2 * up.z()) << "ends of the edge";
  EXPECT_GT(world.force(5).z(), 0.2 * up.z());
}

TEST(SelfContactClose, FindsEachPlaceOnce) {
  const SurfaceMesh rest = roofs(0.5e-3);
  const VertexTriangles rings(rest.triangles, rest.vertices.size());
  const SurfaceWalls walls(rest, 1e-3);
  std::array<std::vector<double>, 3> at;
  for (const Eigen::Vector3d& p : rest.vertices)
    for (std::size_t k = 0; k < 3; ++k) at[k].push_back(p[static_cast<Eigen::Index>(k)]);
  SelfContactClose close(rest.triangles, rings, walls);
  const std::vector<SelfContactClose::Facing> all = {{0, 2}, {0, 3}, {1, 2}, {1, 3}};  // each ridge with both roofs
  ASSERT_EQ(close.find(all, at, 1e-3).size(), 1U);
  const ClosePoints place = close.find(all, at, 1e-3)[0];
  EXPECT_EQ(place.node, (std::array<int, 4>{0, 1, 4, 5}));
  EXPECT_NEAR(place.away.norm(), 0.5e-3, 1e-12);
  EXPECT_NEAR(place.share, 1, 1e-12);
  for (const double weight : place.weight) EXPECT_NEAR(std::abs(weight), 0.5, 1e-12);
  EXPECT_TRUE(close.find(all, at, 0.4e-3).empty());
}

using Places = std::set<std::pair<int, std::array<int, 4>>>;  // by split and nodes

Places placesOf(const std::vector<ClosePoints>& found) {
  Places places;
  for (const ClosePoints& place : found) EXPECT_TRUE(places.insert({place.split, place.node}).second) << "found twice";
  return places;
}

// Each vertex against each triangle, each edge against each edge.
Places placesByTrial(const SurfaceMesh& mesh, const std::array<std::vector<double>, 3>& at, double distance) {
  const auto p = [&](int i) { return Eigen::Vector3d(at[0][i], at[1][i], at[2][i]); };
  std::set<std::array<int, 2>> edges;
  for (const auto& t : mesh.triangles)
    for (int k = 0; k < 3; ++k) edges.insert({std::min(t[k], t[(k + 1) % 3]), std::max(t[k], t[(k + 1) % 3])});
  Places places;
  for (const auto& a : edges)
    for (const auto& b : edges) {
      if (!(a < b) || a[0] == b[0] || a[0] == b[1] || a[1] == b[0] || a[1] == b[1]) continue;
      Eigen::Matrix<double, 3, 2> along;
      along << p(a[1]) - p(a[0]), p(b[0]) - p(b[1]);
      const Eigen::Vector2d part = along.colPivHouseholderQr().solve(p(b[0]) - p(a[0]));
      const bool inside = part.minCoeff() > 0 && part.maxCoeff() < 1;
      if (inside && (p(a[0]) + along * part - p(b[0])).norm() < distance) places.insert({2, {a[0], a[1], b[0], b[1]}});
    }
  for (int v = 0; v < static_cast<int>(mesh.vertices.size()); ++v)
    for (auto t : mesh.triangles) {
      std::sort(t.begin(), t.end());
      if (std::find(t.begin(), t.end(), v) != t.end()) continue;
      const TriangleFoot foot = triangleFoot(p(v), p(t[0]), p(t[1]), p(t[2]));
      if (foot.away.norm() < distance && foot.weight.minCoeff() > 0) places.insert({1, {v, t[0], t[1], t[2]}});
    }
  return places;
}

// Of the feet on edges and vertices only those that are local minima count; the others must be all there.
TEST(SelfContactClose, FindsWhatTrialFindsInACrumpledBall) {
  constexpr double kDistance = 2e-3;
  const SurfaceMesh mesh = sphere(0.01, 4);
  const VertexTriangles rings(mesh.triangles, mesh.vertices.size());
  const SurfaceWalls walls(mesh, 1e-3);
  SelfContactClose close(mesh.triangles, rings, walls);
  std::vector<SelfContactClose::Facing> all;
  for (int v = 0; v < static_cast<int>(mesh.vertices.size()); ++v)
    for (int t = 0; t < static_cast<int>(mesh.triangles.size()); ++t) all.push_back({v, t});
  std::mt19937 random(4);
  std::uniform_real_distribution<double> uniform(-4e-3, 4e-3);
  std::array<std::vector<double>, 3> at;
  for (const Eigen::Vector3d& p : mesh.vertices)
    for (Eigen::Index k = 0; k < 3; ++k) at[static_cast<std::size_t>(k)].push_back(p[k] + uniform(random));
  Places found = placesOf(close.find(all, at, kDistance));
  const Places expected = placesByTrial(mesh, at, kDistance);
  for (auto place = found.begin(); place != found.end();)
    place = place->first == 1 && place->second[3] < 0 ? found.erase(place) : std::next(place);
  EXPECT_GT(expected.size(), 100U);
  EXPECT_EQ(found, expected);
}

TEST(SelfContactClose, FindsTheSameBitsWithAnyNumberOfThreads) {
  const SurfaceMesh mesh = sphere(0.01, 12);
  ASSERT_GT(mesh.triangles.size(), 1000U) << "one piece tests nothing";
  const VertexTriangles rings(mesh.triangles, mesh.vertices.size());
  const SurfaceWalls walls(mesh, 1e-3);
  SelfContactClose close(mesh.triangles, rings, walls);
  std::mt19937 random(5);
  std::uniform_real_distribution<double> uniform(-4e-3, 4e-3);
  std::array<std::vector<double>, 3> at;
  for (const Eigen::Vector3d& p : mesh.vertices)
    for (Eigen::Index k = 0; k < 3; ++k) at[static_cast<std::size_t>(k)].push_back(p[k] + uniform(random));
  std::vector<SelfContactClose::Facing> some;
  for (int v = 0; v < static_cast<int>(mesh.vertices.size()); ++v)
    for (int t = v % 97; t < static_cast<int>(mesh.triangles.size()); t += 97) some.push_back({v, t});
  const std::vector<ClosePoints> one = close.find(some, at, 1e-3);
  ASSERT_GT(one.size(), 100U);
  for (const int threads : {1, 2, 5}) {
    ThreadPool pool(threads);
    const std::vector<ClosePoints>& found = close.find(some, at, 1e-3, &pool);
    ASSERT_EQ(found.size(), one.size()) << threads;
    for (std::size_t i = 0; i < one.size(); ++i) {
      ASSERT_EQ(found[i].node, one[i].node) << i;
      ASSERT_EQ(found[i].weight, one[i].weight) << i;
      ASSERT_EQ(found[i].away, one[i].away) << i;
    }
  }
}

/// A plate of 1 mm cells.
SurfaceMesh plate() {
  SurfaceMesh mesh;
  addPlate(16, 1e-3, 0, true, mesh);
  return mesh;
}

/// Folds it flat about the y axis.
void fold(double gap, ContactWorld& world) {
  for (std::size_t i = 0; i < world.count(); ++i) {
    const Eigen::Vector3d& p = world.rest.vertices[i];
    if (p.x() > 0) world.set(i, {-p.x(), p.y(), gap});
  }
  world.detect(0);
  world.evaluate();
}

/// Bars between places that are one wall.
std::size_t countInWall(const ContactWorld& world) {
  constexpr double kBar = 0.3 * kWallThickness * (1 + 1e-9);
  std::size_t count = 0;
  for (const SelfContact::Pair& pair : world.contact.pairs()) {
    Eigen::Vector3d at_rest = Eigen::Vector3d::Zero();
    for (std::size_t k = 0; k < 4; ++k)
      if (pair.node[k] >= 0) at_rest += pair.weight[k] * world.rest.vertices[static_cast<std::size_t>(pair.node[k])];
    if (pair.thickness > kBar || at_rest.norm() > 1.55 * kWallThickness) continue;
    ++count;
  }
  return count;
}

// Two sides of a fold that are one wall, because they are near along the surface, push each other apart.
TEST(SelfContactClose, BarsActWithinASharpFold) {
  ContactWorld sharp(plate()), wide(plate());
  fold(0.1 * kWallThickness, sharp);
  EXPECT_GT(countInWall(sharp), 10U);
  for (std::size_t i = 0; i < sharp.count(); ++i) {
    const Eigen::Vector3d& p = sharp.rest.vertices[i];
    if (std::abs(p.x() - 2e-3) > 1e-6 || std::abs(p.y()) > 5e-3) continue;
    EXPECT_GT(sharp.force(i).z(), 0) << i;
  }
  fold(0.6 * kWallThickness, wide);
  EXPECT_EQ(countInWall(wide), 0U);
}

// The upper roof is heavy, and only moves up and down.
TEST(SelfContactClose, EdgesThatCrossComeToRestBeforeTheyAreStopped) {
  constexpr double kGap = 1.5 * kWallThickness, kWeight = 0.05;  // [m], [N]
  const SurfaceMesh rest = roofs(kGap);
  ShellMesh mesh;
  mesh.nodes = rest.vertices;
  mesh.triangles = rest.triangles;
  mesh.thickness.assign(rest.triangles.size(), kWallThickness);
  mesh.materials = {Material{Law::NeoHookean, kModulus, 0.45, 0}};
  ElasticBody body;
  body.elements = std::make_shared<const ShellElements>(mesh);
  body.rest = rest.vertices;
  body.mass.assign(8, kWeight / 4 / 9.81);
  body.fixed = {1, 1, 1, 1, 0, 0, 0, 0};
  body.gravity = {0, 0, -9.81};
  body.mass_damping = 30;
  StepSettings settings;
  settings.step = kStep;
  settings.iterations = 4;
  const ImplicitStepper stepper(body, settings);
  BodyMotion motion(body);
  const std::shared_ptr<StepperWorkspace> scratch = stepper.makeWorkspace();
  StepperMemory memory;
  BodyLoads loads;
  for (int v = 4; v < 8; ++v)
    for (int k = 0; k < 2; ++k) {
      LinearConstraint& constraint = loads.constraints.add();
      constraint.node = {v};
      constraint.coefficient = {Eigen::Vector3d::Unit(k)};
      constraint.target = rest.vertices[v][k];
    }
  SelfContact contact(rest, std::vector<double>(8, kWallThickness), kModulus);
  const MotionView view = motion.view();
  std::size_t stopped = 0;
  double before = 0;
  for (int step = 0; step < 240; ++step) {
    if (step == 180) stopped = 0, before = view.x[2][4];
    contact.detect({view.x[0], view.x[1], view.x[2]}, {view.v[0], view.v[1], view.v[2]}, 0.5e-3, kStep);
    loads.extra = &contact;
    ASSERT_TRUE(stepper.step(view, loads, memory, *scratch).finite);
    stopped += contact.resolvePenetrations(view, kStep).size();
  }
  EXPECT_EQ(stopped, 0U) << "in the last second";
  EXPECT_GT(view.x[2][4], 0.05 * kWallThickness);
  EXPECT_LT(view.x[2][4], 0.375 * kWallThickness) << "the edges touch";
  EXPECT_NEAR(view.x[2][4], before, 1e-6) << "at rest";
}

}  // namespace
}  // namespace vibe::self_contact_close_test
