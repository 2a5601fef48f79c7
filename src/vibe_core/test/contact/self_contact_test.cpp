#include "contact/self_contact.hpp"

#include <gtest/gtest.h>
#include <time.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <map>
#include <random>
#include <tuple>

#include "vibe_core/common/error.hpp"

namespace vibe {
namespace {

constexpr double kThickness = 3e-3, kModulus = 5e4, kStep = 1.0 / 60;

/// A square grid of cells x cells squares about the z axis at height z, its normals up or down.
void addPlate(int cells, double spacing, double z, bool up, SurfaceMesh& mesh) {
  const int first = static_cast<int>(mesh.vertices.size()), row = cells + 1;
  for (int j = 0; j <= cells; ++j)
    for (int i = 0; i <= cells; ++i)
      mesh.vertices.push_back({spacing * (i - 0.5 * cells), spacing * (j - 0.5 * cells), z});
  for (int j = 0; j < cells; ++j)
    for (int i = 0; i < cells; ++i) {
      const int a = first + j * row + i, b = a + 1, c = a + row, d = c + 1;
      for (auto t : {std::array<int, 3>{a, b, d}, std::array<int, 3>{a, d, c}}) {
        if (!up) std::swap(t[1], t[2]);
        mesh.triangles.push_back(t);
      }
    }
}

/// Two plates that face each other, far apart.
SurfaceMesh plates(int lower, int upper, double spacing = 2.5e-3) {
  SurfaceMesh mesh;
  addPlate(lower, spacing, 0, true, mesh);
  addPlate(upper, spacing, 0.1, false, mesh);
  return mesh;
}

int plateSize(int cells) {
  return (cells + 1) * (cells + 1);
}

/// An icosahedron whose faces are cut into parts^2 triangles, on a sphere: 10 parts^2 + 2 vertices.
SurfaceMesh sphere(double radius, int parts) {
  const double g = (1 + std::sqrt(5.0)) / 2;
  const std::vector<Eigen::Vector3d> corner = {{-1, g, 0}, {1, g, 0}, {-1, -g, 0}, {1, -g, 0},
                                               {0, -1, g}, {0, 1, g}, {0, -1, -g}, {0, 1, -g},
                                               {g, 0, -1}, {g, 0, 1}, {-g, 0, -1}, {-g, 0, 1}};
  const int faces[20][3] = {{0, 11, 5},  {0, 5, 1},  {0, 1, 7},  {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
                            {11, 10, 2}, {10, 7, 6}, {7, 1, 8},  {3, 9, 4},  {3, 4, 2},   {3, 2, 6}, {3, 6, 8},
                            {3, 8, 9},   {4, 9, 5},  {2, 4, 11}, {6, 2, 10}, {8, 6, 7},   {9, 8, 1}};
  SurfaceMesh mesh;
  std::map<std::tuple<long, long, long>, int> known;
  for (const auto& face : faces) {
    auto vertex = [&](int i, int j) {
      const Eigen::Vector3d p =
          (corner[face[0]] * (parts - i - j) + corner[face[1]] * i + corner[face[2]] * j).normalized();
      const auto key = std::make_tuple(std::lround(p.x() * 1e6), std::lround(p.y() * 1e6), std::lround(p.z() * 1e6));
      const auto [found, fresh] = known.insert({key, static_cast<int>(mesh.vertices.size())});
      if (fresh) mesh.vertices.push_back(radius * p);
      return found->second;
    };
    for (int i = 0; i < parts; ++i)
      for (int j = 0; i + j < parts; ++j) {
        mesh.triangles.push_back({vertex(i, j), vertex(i + 1, j), vertex(i, j + 1)});
        if (i + j + 1 < parts) mesh.triangles.push_back({vertex(i + 1, j), vertex(i + 1, j + 1), vertex(i, j + 1)});
      }
  }
  return mesh;
}

struct World {
  explicit World(SurfaceMesh rest_mesh, double thickness = kThickness)
      : rest(std::move(rest_mesh)),
        contact(rest, std::vector<double>(rest.vertices.size(), thickness), kModulus),
        at(4 * rest.vertices.size()),
        gradient(4 * rest.vertices.size()) {
    for (std::size_t i = 0; i < rest.vertices.size(); ++i) set(i, rest.vertices[i]);
  }
  std::size_t count() const { return rest.vertices.size(); }
  Eigen::Vector3d get(std::size_t i) const { return {at[4 * i], at[4 * i + 1], at[4 * i + 2]}; }
  void set(std::size_t i, const Eigen::Vector3d& p) {
    for (int k = 0; k < 3; ++k) at[4 * i + k] = p[k];
  }
  void detect(double reach) {
    for (std::size_t k = 0; k < 3; ++k) {
      position[k].resize(count());
      for (std::size_t i = 0; i < count(); ++i) position[k][i] = at[4 * i + k];
      speed[k].resize(count(), 0);
    }
    contact.detect({position[0].data(), position[1].data(), position[2].data()},
                   {speed[0].data(), speed[1].data(), speed[2].data()}, reach, kStep);
  }
  /// Ends a step that has moved by `move` since detect().
  std::size_t resolvePenetrations(const std::vector<double>& move) {
    std::array<std::vector<double>, 3> x, v, a;
    for (std::size_t i = 0; i < count(); ++i)
      for (std::size_t k = 0; k < 3; ++k) {
        x[k].push_back(at[4 * i + k] + move[4 * i + k]);
        v[k].push_back(7);
        a[k].push_back(7);
      }
    const MotionView view{{x[0].data(), x[1].data(), x[2].data()},
                          {v[0].data(), v[1].data(), v[2].data()},
                          {a[0].data(), a[1].data(), a[2].data()}};
    const std::vector<int>& stopped = contact.resolvePenetrations(view, kStep);
    for (const int i : stopped)
      for (std::size_t k = 0; k < 3; ++k) {
        EXPECT_NEAR(v[k][i], (x[k][i] - at[4 * static_cast<std::size_t>(i) + k]) / kStep, 1e-9);
        EXPECT_EQ(a[k][i], 0);
      }
    for (std::size_t i = 0; i < count(); ++i)
      for (std::size_t k = 0; k < 3; ++k) at[4 * i + k] = x[k][i];
    return stopped.size();
  }
  double evaluate() {
    std::fill(gradient.begin(), gradient.end(), 0.0F);
    return contact.evaluate(at.data(), gradient.data());
  }
  Eigen::Vector3d force(std::size_t i) const { return {-gradient[4 * i], -gradient[4 * i + 1], -gradient[4 * i + 2]}; }
  Eigen::Vector3d totalForce(std::size_t first, std::size_t last) const {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (std::size_t i = first; i < last; ++i) sum += force(i);
    return sum;
  }
  /// Places the upper of two plates over the lower one.
  void bring(int first_upper, double gap, const Eigen::Vector2d& aside = {0.4e-3, 0.7e-3}) {
    for (std::size_t i = first_upper; i < count(); ++i)
      set(i, {rest.vertices[i].x() + aside.x(), rest.vertices[i].y() + aside.y(), gap});
  }
  void shake(double size, unsigned seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> uniform(-size, size);
    for (double& value : at) value += uniform(random);
  }

  SurfaceMesh rest;
  SelfContact contact;
  std::array<std::vector<double>, 3> position, speed;  // at detect()
  std::vector<double> at;
  std::vector<float> gradient;
};

struct PressedPlates : World {
  PressedPlates() : World(plates(8, 6)) {
    bring(plateSize(8), 0.6 * kThickness);
    shake(0.2e-3, 1);
    detect(1e-3);
  }
};

TEST(SelfContact, GradientIsDerivativeOfEnergy) {
  PressedPlates world;
  ASSERT_GT(world.contact.pairs().size(), 60U);
  ASSERT_GT(world.evaluate(), 0);
  const std::vector<float> gradient = world.gradient;
  const double largest = *std::max_element(gradient.begin(), gradient.end());
  ASSERT_GT(largest, 1e-3);
  for (std::size_t i = 0; i < world.at.size(); ++i) {
    if (i % 4 == 3) continue;
    const double kept = world.at[i], step = 1e-8;
    world.at[i] = kept + step;
    const double above = world.evaluate();
    world.at[i] = kept - step;
    const double below = world.evaluate();
    world.at[i] = kept;
    EXPECT_NEAR(gradient[i], (above - below) / (2 * step), 2e-5 * largest) << "component " << i;
  }
}

// x . K x of the couplings.
double quadratic(const std::vector<StiffnessCoupling>& couplings, const std::vector<double>& x) {
  double sum = 0;
  for (const StiffnessCoupling& c : couplings) {
    Eigen::Vector3d u = Eigen::Vector3d::Zero();
    for (std::size_t k = 0; k < 4; ++k)
      if (c.node[k] >= 0)
        u += c.weight[k] * Eigen::Vector3d(x[4 * static_cast<std::size_t>(c.node[k])],
                                           x[4 * static_cast<std::size_t>(c.node[k]) + 1],
                                           x[4 * static_cast<std::size_t>(c.node[k]) + 2]);
    Eigen::Matrix3d stiffness;
    stiffness << c.stiffness[0], c.stiffness[1], c.stiffness[2], c.stiffness[1], c.stiffness[3], c.stiffness[4],
        c.stiffness[2], c.stiffness[4], c.stiffness[5];
    sum += u.dot(stiffness * u);
  }
  return sum;
}

TEST(SelfContact, StiffnessIsSecondDerivativeOfEnergy) {
  PressedPlates world;
  std::vector<StiffnessCoupling> couplings;
  world.contact.addStiffness(world.at.data(), couplings);
  ASSERT_GT(couplings.size(), 60U);
  std::mt19937 random(5);
  std::normal_distribution<double> normal;
  for (int trial = 0; trial < 5; ++trial) {
    std::vector<double> way(world.at.size());
    for (double& value : way) value = normal(random);
    const double step = 1e-7, middle = world.evaluate();
    const std::vector<double> at = world.at;
    for (std::size_t i = 0; i < at.size(); ++i) world.at[i] = at[i] + step * way[i];
    const double above = world.evaluate();
    for (std::size_t i = 0; i < at.size(); ++i) world.at[i] = at[i] - step * way[i];
    const double below = world.evaluate();
    world.at = at;
    const double second = (above - 2 * middle + below) / (step * step);
    EXPECT_NEAR(quadratic(couplings, way), second, 1e-3 * second);
  }
}

TEST(SelfContact, MomentumAndMomentAreConserved) {
  PressedPlates world;
  world.evaluate();
  Eigen::Vector3d force = Eigen::Vector3d::Zero(), moment = Eigen::Vector3d::Zero();
  double sum = 0;
  for (std::size_t i = 0; i < world.count(); ++i) {
    force += world.force(i);
    moment += world.get(i).cross(world.force(i));
    sum += world.force(i).norm();
  }
  ASSERT_GT(sum, 0.1);
  EXPECT_LT(force.norm(), 1e-6 * sum);
  EXPECT_LT(moment.norm(), 1e-6 * sum * 0.02);
}

// Strain of a plate that a larger one carries under a load, by bisection.
double strainUnder(double load) {
  World world(plates(46, 40));
  const int first = plateSize(46);
  double low = 0.2 * kThickness, high = 1.1 * kThickness;
  for (int i = 0; i < 20; ++i) {
    const double gap = 0.5 * (low + high);
    world.bring(first, gap);
    world.detect(1e-3);
    world.evaluate();
    (world.totalForce(first, world.count()).z() > load ? low : high) = gap;
  }
  return 1 - low / kThickness;
}

TEST(SelfContact, PlateOnPlateCarriesTheForceOfTheSqueezedWall) {
  const double area = std::pow(40 * 2.5e-3, 2), modulus = 0.1 * kModulus;
  for (const double stress : {0.5, 1.0, 1.5}) {
    const double s = 1 - strainUnder(stress * modulus * area);
    EXPECT_NEAR(-std::log(s) / s, stress, 0.04 * stress);  // Hencky; the rim takes a little more than its area
  }
}

TEST(SelfContact, ForceIsZeroBeyondOnsetGrowsWithoutJumpAndStaysFinite) {
  World world(plates(8, 6));
  double last = 0, largest_change = 0;
  for (double s = 1.4; s > 0.3; s -= 1e-3) {
    world.bring(plateSize(8), s * kThickness);
    world.detect(1e-3);
    const double energy = world.evaluate();
    const double force = world.totalForce(plateSize(8), world.count()).z();
    if (s > 1.251) {
      ASSERT_EQ(energy, 0);
    }
    ASSERT_GE(force, last);
    largest_change = std::max(largest_change, (force - last) / std::max(force, kModulus * 1e-5));
    last = force;
  }
  EXPECT_LT(largest_change, 0.05);
  world.detect(1e-3);
  world.bring(plateSize(8), -0.4 * kThickness);  // through: pushed back to the side where it was
  EXPECT_TRUE(std::isfinite(world.evaluate()));
  EXPECT_GT(world.totalForce(plateSize(8), world.count()).z(), last);
}

TEST(SelfContact, BothSidesAreTreatedAlike) {
  PressedPlates world;
  SurfaceMesh inside_out = world.rest;
  for (auto& t : inside_out.triangles) std::swap(t[1], t[2]);
  World other(inside_out);
  other.at = world.at;
  other.detect(1e-3);
  const double energy = world.evaluate();
  EXPECT_NEAR(other.evaluate(), energy, 1e-9 * energy);
  for (std::size_t i = 0; i < world.count(); ++i)
    EXPECT_LT((world.force(i) - other.force(i)).norm(), 1e-5 * (1e-3 + world.force(i).norm()));
}

double minGap(const World& world, int cells) {
  const int upper = plateSize(cells);
  double min = std::numeric_limits<double>::infinity();
  for (int i = 0; i < upper; ++i) min = std::min(min, world.get(upper + i).z() - world.get(i).z());
  return min;
}

double pressAtRandom(bool limited, double size) {
  const int cells = 8;
  World world(plates(cells, cells));
  world.bring(plateSize(cells), 0.8 * kThickness, {0, 0});
  std::mt19937 random(3);
  std::uniform_real_distribution<double> uniform(-1, 1);
  double min = std::numeric_limits<double>::infinity();
  for (int step = 0; step < 16; ++step) {
    world.detect(2e-3);
    std::vector<double> move(world.at.size(), 0.0);
    const double together = step % 2 == 0 ? 1.0 : -0.8;
    for (int i = 0; i < static_cast<int>(world.count()); ++i)
      move[4 * i + 2] = size * ((i < plateSize(cells) ? together : -together) + 0.5 * uniform(random));
    if (limited) {
      world.resolvePenetrations(move);
    } else {
      for (std::size_t k = 0; k < move.size(); ++k) world.at[k] += move[k];
    }
    min = std::min(min, minGap(world, cells));
  }
  return min;
}

TEST(SelfContact, LargeMovesPassThroughNothing) {
  for (const double size : {0.3e-3, 3e-3, 30e-3}) {
    EXPECT_GT(pressAtRandom(true, size), 0) << size;
    EXPECT_LT(pressAtRandom(false, size), -0.5 * size) << size;  // the moves would
  }
}

// Two strips that cross on edge: no vertex comes near the other one's triangles before the edges meet.
TEST(SelfContact, EdgesDoNotPassThroughEdges) {
  SurfaceMesh mesh;
  mesh.vertices = {{-0.02, 0, 0.01}, {0.02, 0, 0.01}, {0, 0, 0.05},    // an edge along x with its triangle above
                   {0, -0.02, 0},    {0, 0.02, 0},    {0, 0, -0.04}};  // an edge along y with its triangle below
  mesh.triangles = {{0, 1, 2}, {3, 4, 5}};
  World world(mesh);
  world.detect(1e-3);
  std::vector<double> move(world.at.size(), 0.0);
  for (std::size_t i = 0; i < 3; ++i) move[4 * i + 2] = -0.03;
  EXPECT_EQ(world.resolvePenetrations(move), 2U);
  EXPECT_GT(world.get(0).z(), 0);
  EXPECT_LT(world.get(0).z(), 2e-3);
}

TEST(SelfContact, WhatMeetsNothingIsLeftToTheBit) {
  World world(plates(8, 6));
  world.bring(plateSize(8), 0.8 * kThickness);
  for (const double size : {0.1e-3, 50e-3}) {  // together, however fast
    world.detect(1e-3);
    const std::vector<double> before = world.at;
    EXPECT_EQ(world.resolvePenetrations(std::vector<double>(world.at.size(), size)), 0U);
    for (std::size_t k = 0; k < before.size(); ++k) ASSERT_EQ(world.at[k], before[k] + (k % 4 == 3 ? 0 : size));
  }
  world.detect(1e-3);
  std::vector<double> apart(world.at.size(), 0.0);
  for (std::size_t i = plateSize(8); i < world.count(); ++i) apart[4 * i + 2] = 5e-3;
  EXPECT_EQ(world.resolvePenetrations(apart), 0U);
}

TEST(SelfContact, SphereMeetsItselfOnlyWhenFlattened) {
  World world(sphere(0.05, 19));
  ASSERT_EQ(world.count(), 3612U);
  for (const double scale : {1.0, 2.0}) {
    for (std::size_t i = 0; i < world.count(); ++i) world.set(i, scale * world.rest.vertices[i]);
    world.detect(2e-3);
    EXPECT_TRUE(world.contact.pairs().empty()) << scale;
    EXPECT_EQ(world.evaluate(), 0);
  }
  for (std::size_t i = 0; i < world.count(); ++i) {
    Eigen::Vector3d p = world.rest.vertices[i];
    p.z() *= 0.04;
    world.set(i, p);
  }
  world.detect(2e-3);
  EXPECT_GT(world.contact.pairs().size(), 1000U);
  EXPECT_GT(world.evaluate(), 0);
}

TEST(SelfContact, NeighboursAlongTheSurfaceNeverCount) {
  World world(sphere(0.05, 12));
  for (std::size_t i = 0; i < world.count(); ++i) world.set(i, 0.1 * world.rest.vertices[i]);
  world.shake(2e-3, 9);
  world.detect(2e-3);
  ASSERT_GT(world.contact.pairs().size(), 500U);
  double min = 1;
  for (const auto& pair : world.contact.pairs())
    for (std::size_t k = 1; k < 4; ++k)
      min = std::min(min, (world.rest.vertices[pair.node[k]] - world.rest.vertices[pair.node[0]]).norm());
  EXPECT_GT(min, 2 * kThickness);
}

TEST(SelfContact, WallsNearAtRestTouchThere) {
  SurfaceMesh mesh = plates(8, 6);
  for (int i = plateSize(8); i < static_cast<int>(mesh.vertices.size()); ++i) mesh.vertices[i].z() = 0.5 * kThickness;
  World world(mesh);
  world.detect(1e-3);
  ASSERT_FALSE(world.contact.pairs().empty());
  EXPECT_LT(world.evaluate(), 1e-30);
  for (int i = plateSize(8); i < static_cast<int>(mesh.vertices.size()); ++i) world.at[4 * i + 2] *= 0.8;
  EXPECT_GT(world.evaluate(), 0);
}

TEST(SelfContact, ResultDoesNotDependOnHistory) {
  PressedPlates fresh;
  World old(plates(8, 6));
  for (const double gap : {0.05, 0.01, 4e-3, 3e-3, -1e-3}) {
    old.bring(plateSize(8), gap);
    old.detect(gap > 5e-3 ? 2e-3 : 0.5e-3);
  }
  old.at = fresh.at;
  old.detect(1e-3);
  ASSERT_EQ(old.contact.pairs().size(), fresh.contact.pairs().size());
  EXPECT_EQ(old.evaluate(), fresh.evaluate());
  EXPECT_EQ(old.gradient, fresh.gradient);
}

TEST(SelfContact, SearchesOnlyWhenSomethingCanHaveComeNear) {
  World world(plates(8, 6));
  world.detect(1e-3);
  world.detect(1e-3);
  EXPECT_EQ(world.contact.searchCount(), 1);
  double gap = 0.1;
  while (world.contact.pairs().empty() && gap > 0) {  // the approach is not missed in spite of the skipped searches
    gap -= 0.1e-3;
    world.bring(plateSize(8), gap, {0, 0});
    world.detect(1e-3);
  }
  EXPECT_NEAR(gap, 1.25 * kThickness + 1e-3, 0.11e-3);
  EXPECT_LT(world.contact.searchCount(), 320);
}

TEST(SelfContact, PositionsThatAreNotFiniteMeetNothing) {
  PressedPlates world;
  world.at[4] = std::numeric_limits<double>::quiet_NaN();
  world.detect(1e-3);
  EXPECT_TRUE(world.contact.pairs().empty());
  world.at[4] = 0;
  world.detect(1e-3);
  EXPECT_FALSE(world.contact.pairs().empty());
}

TEST(SelfContact, RejectsWhatItCannotUse) {
  const SurfaceMesh mesh = plates(2, 2);
  std::vector<double> thickness(mesh.vertices.size(), kThickness);
  EXPECT_NO_THROW(SelfContact(mesh, thickness, kModulus));
  EXPECT_THROW(SelfContact(mesh, thickness, 0), Error);
  thickness[3] = 0;
  EXPECT_THROW(SelfContact(mesh, thickness, kModulus), Error);
  thickness.pop_back();
  EXPECT_THROW(SelfContact(mesh, thickness, kModulus), Error);
  SurfaceMesh broken = mesh;
  broken.triangles[1][2] = 99;
  EXPECT_THROW(SelfContact(broken, std::vector<double>(mesh.vertices.size(), kThickness), kModulus), Error);
}

double threadTime() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return 1e3 * static_cast<double>(now.tv_sec) + 1e-6 * static_cast<double>(now.tv_nsec);
}

// `moved` of the nodes between calls; median and least time of a step's calls [ms]
std::pair<double, double> measure(World& world, double moved) {
  std::array<std::vector<double>, 3> x;
  std::vector<double> v(world.count()), times;
  for (std::size_t i = 0; i < world.count(); ++i)
    for (std::size_t k = 0; k < 3; ++k) x[k].push_back(world.at[4 * i + k]);
  const MotionView view{
      {x[0].data(), x[1].data(), x[2].data()}, {v.data(), v.data(), v.data()}, {v.data(), v.data(), v.data()}};
  for (int i = 0; i < 201; ++i) {
    const double start = threadTime();
    world.contact.detect({x[0].data(), x[1].data(), x[2].data()}, {v.data(), v.data(), v.data()}, 2e-3, kStep);
    for (double& value : x[0]) value += i % 2 == 0 ? moved : -moved;
    world.contact.resolvePenetrations(view, kStep);
    times.push_back(threadTime() - start);
  }
  std::sort(times.begin(), times.end());
  return {times[times.size() / 2], times.front()};
}

TEST(SelfContact, CostsLittleWhereNothingIsNear) {
  World world(sphere(0.05, 19));
  const auto still = measure(world, 1e-7), moving = measure(world, 5e-3);
  World pinched(sphere(0.05, 19));  // pinched about its axis until the poles meet
  for (std::size_t i = 0; i < pinched.count(); ++i) {
    const double off = std::hypot(pinched.at[4 * i], pinched.at[4 * i + 1]);
    pinched.at[4 * i + 2] *= std::clamp((off - 0.012) / 0.028, 0.025, 1.0);
  }
  const auto local = measure(pinched, 1e-7);
  std::printf("still %.4f (%.4f) ms, searching %.3f (%.3f) ms, pinched, %zu pairs: %.3f (%.3f) ms\n", still.first,
              still.second, moving.first, moving.second, pinched.contact.pairs().size(), local.first, local.second);
  const double start = threadTime();
  for (int i = 0; i < 100; ++i) pinched.evaluate();
  std::printf("pinched: evaluate %.4f ms\n", (threadTime() - start) / 100);
#if defined(__OPTIMIZE__) && !defined(__SANITIZE_ADDRESS__)
  EXPECT_LT(still.second, 0.02);
#endif
}

}  // namespace
}  // namespace vibe
