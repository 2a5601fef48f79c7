// Walls of a shell that are pulled, thrown and folded together while implicit steps solve for them: nothing passes
// through anything at the end of any step, and what is let go comes back.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "self_contact/self_contact.hpp"
#include "tissue/shell_worlds.hpp"
#include "vibe_core/solver/implicit_stepper.hpp"

namespace vibe::self_contact_cinch_test {
namespace {

constexpr double kStep = 1.0 / 60, kWall = 2.3e-3, kModulus = 1.1e5;

double volumeOfSix(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c,
                   const Eigen::Vector3d& d) {
  return (b - a).cross(c - a).dot(d - a);
}

bool pierces(const Eigen::Vector3d& p, const Eigen::Vector3d& q, const Eigen::Vector3d& a, const Eigen::Vector3d& b,
             const Eigen::Vector3d& c) {
  if (volumeOfSix(a, b, c, p) * volumeOfSix(a, b, c, q) >= 0) return false;
  const double ab = volumeOfSix(p, q, a, b), bc = volumeOfSix(p, q, b, c), ca = volumeOfSix(p, q, c, a);
  return (ab > 0 && bc > 0 && ca > 0) || (ab < 0 && bc < 0 && ca < 0);
}

/// A closed shell on a weak foundation, walls that meet, and what pulls on it.
class Cinch {
 public:
  /// @param size  of an ellipsoid, along x, y and z [m]
  Cinch(const Eigen::Vector3d& size, int cuts, bool contact) : contact_on_(contact) {
    ShellMesh mesh = test::sphere(cuts, 0.5);
    for (Eigen::Vector3d& p : mesh.nodes) p = p.cwiseProduct(size);
    mesh.materials = {Material{Law::Yeoh, kModulus, 0.45, 2}};
    std::fill(mesh.thickness.begin(), mesh.thickness.end(), kWall);
    surface = {mesh.nodes, mesh.triangles};
    const auto elements = std::make_shared<const ShellElements>(mesh);
    ElasticBody body;
    body.elements = elements;
    body.rest = mesh.nodes;
    for (const double area : vertexAreas(surface)) {
      body.mass.push_back(1050 * kWall * area);
      body.foundation.push_back(5e3 * area);
    }
    body.fixed.assign(mesh.nodes.size(), 0);
    body.mass_damping = 30;
    StepSettings settings;
    settings.step = kStep;
    settings.iterations = 10;
    stepper = std::make_unique<ImplicitStepper>(body, settings);
    motion = std::make_unique<BodyMotion>(stepper->body());
    scratch = stepper->makeWorkspace();
    forget();
  }

  void step() {
    const MotionView view = motion->view();
    double fastest = 0;
    for (std::size_t i = 0; i < surface.vertices.size(); ++i) fastest = std::max(fastest, velocity(i).norm());
    if (contact_on_) {
      contact_->detect({view.x[0], view.x[1], view.x[2]}, {view.v[0], view.v[1], view.v[2]},
                       std::clamp(2.5 * kStep * fastest, 5e-4, 2e-3), kStep);
      loads.extra = contact_.get();
    }
    const StepOutcome outcome = stepper->step(view, loads, memory, *scratch);
    finite = finite && outcome.finite;
    if (contact_on_) stopped += static_cast<int>(contact_->resolvePenetrations(view, kStep).size());
    pairs = static_cast<int>(contact_->pairs().size());
    meetings += countMeetings();
  }

  Eigen::Vector3d position(std::size_t i) const { return {motion->x[0][i], motion->x[1][i], motion->x[2][i]}; }
  Eigen::Vector3d velocity(std::size_t i) const { return {motion->v[0][i], motion->v[1][i], motion->v[2][i]}; }

  /// The nodes nearest to a point at rest.
  std::vector<int> patch(const Eigen::Vector3d& at, std::size_t count) const {
    std::vector<int> node(surface.vertices.size());
    std::iota(node.begin(), node.end(), 0);
    std::sort(node.begin(), node.end(), [&](int a, int b) {
      return (surface.vertices[a] - at).squaredNorm() < (surface.vertices[b] - at).squaredNorm();
    });
    node.resize(count);
    return node;
  }

  /// A thread between two patches: three constraints, which `hold` shortens.
  void thread(const std::vector<int>& one, const std::vector<int>& other) {
    for (int k = 0; k < 3; ++k) {
      LinearConstraint constraint;
      for (const int v : one) {
        constraint.node.push_back(v);
        constraint.coefficient.push_back(Eigen::Vector3d::Unit(k) / static_cast<double>(one.size()));
        constraint.target += surface.vertices[v][k] / static_cast<double>(one.size());
      }
      for (const int v : other) {
        constraint.node.push_back(v);
        constraint.coefficient.push_back(-Eigen::Vector3d::Unit(k) / static_cast<double>(other.size()));
        constraint.target -= surface.vertices[v][k] / static_cast<double>(other.size());
      }
      whole.push_back(constraint.target);
      loads.constraints.push_back(constraint);
    }
  }
  void hold(double part) {
    for (std::size_t k = 0; k < loads.constraints.size(); ++k) loads.constraints[k].target = part * whole[k];
  }
  /// Holds the middle of a patch so far from where it is at rest.
  void put(const std::vector<int>& patch, const Eigen::Vector3d& away) {
    for (int k = 0; k < 3; ++k) {
      LinearConstraint constraint;
      constraint.target = away[k];
      for (const int v : patch) {
        constraint.node.push_back(v);
        constraint.coefficient.push_back(Eigen::Vector3d::Unit(k) / static_cast<double>(patch.size()));
        constraint.target += surface.vertices[v][k] / static_cast<double>(patch.size());
      }
      loads.constraints.push_back(constraint);
    }
  }
  /// Throws away what the contact remembers.
  void forget() {
    contact_ = std::make_unique<SelfContact>(surface, std::vector<double>(surface.vertices.size(), kWall), kModulus);
  }
  double distanceLeft() const {
    Eigen::Vector3d left = Eigen::Vector3d::Zero();
    for (std::size_t c = 0; c < 3; ++c)
      for (std::size_t k = 0; k < loads.constraints[c].node.size(); ++k)
        left[c] += loads.constraints[c].coefficient[k].dot(position(loads.constraints[c].node[k]));
    return left.norm();
  }
  double fastest() const {
    double max = 0;
    for (std::size_t i = 0; i < surface.vertices.size(); ++i) max = std::max(max, velocity(i).norm());
    return max;
  }
  double fromRest() const {
    double max = 0;
    for (std::size_t i = 0; i < surface.vertices.size(); ++i)
      max = std::max(max, (position(i) - surface.vertices[i]).norm());
    return max;
  }

  /// Pairs of triangles without a common vertex of which one passes through the other.
  int countMeetings() const {
    std::vector<Eigen::Vector3d> at;
    for (std::size_t i = 0; i < surface.vertices.size(); ++i) at.push_back(position(i));
    struct Box {
      Eigen::Vector3d low, high;
      int triangle;
    };
    std::vector<Box> boxes;
    for (std::size_t t = 0; t < surface.triangles.size(); ++t) {
      const auto& n = surface.triangles[t];
      boxes.push_back({at[n[0]].cwiseMin(at[n[1]]).cwiseMin(at[n[2]]), at[n[0]].cwiseMax(at[n[1]]).cwiseMax(at[n[2]]),
                       static_cast<int>(t)});
    }
    std::sort(boxes.begin(), boxes.end(), [](const Box& a, const Box& b) { return a.low.x() < b.low.x(); });
    int count = 0;
    for (std::size_t i = 0; i < boxes.size(); ++i)
      for (std::size_t j = i + 1; j < boxes.size() && boxes[j].low.x() <= boxes[i].high.x(); ++j) {
        if ((boxes[j].low.array() > boxes[i].high.array()).any() ||
            (boxes[i].low.array() > boxes[j].high.array()).any())
          continue;
        count += meet(surface.triangles[boxes[i].triangle], surface.triangles[boxes[j].triangle], at) ? 1 : 0;
      }
    return count;
  }

  SurfaceMesh surface;
  std::unique_ptr<ImplicitStepper> stepper;
  std::unique_ptr<BodyMotion> motion;
  std::shared_ptr<StepperWorkspace> scratch;
  StepperMemory memory;
  BodyLoads loads;
  std::vector<double> whole;
  bool finite = true;
  int stopped = 0, pairs = 0, meetings = 0;

 private:
  static bool meet(const std::array<int, 3>& a, const std::array<int, 3>& b, const std::vector<Eigen::Vector3d>& at) {
    for (const int v : a)
      if (std::find(b.begin(), b.end(), v) != b.end()) return false;
    for (int k = 0; k < 3; ++k)
      if (pierces(at[a[k]], at[a[(k + 1) % 3]], at[b[0]], at[b[1]], at[b[2]]) ||
          pierces(at[b[k]], at[b[(k + 1) % 3]], at[a[0]], at[a[1]], at[a[2]]))
        return true;
    return false;
  }
  bool contact_on_;
  std::unique_ptr<SelfContact> contact_;
};

const Eigen::Vector3d kFlat(0.08, 0.08, 0.04);
constexpr double kLength = 0.08;

struct Held {
  double moved = 0;    // farthest in the last half second [m]
  double fastest = 0;  // at the end [m/s]
};

// Two patches pulled together, and held for two seconds.
Held pullTogether(Cinch& world, const std::vector<int>& one, const std::vector<int>& other, double seconds,
                  double left) {
  world.thread(one, other);
  const int frames = std::max(1, static_cast<int>(std::lround(seconds / kStep)));
  std::vector<Eigen::Vector3d> before;
  for (int i = 1; i <= frames + 120; ++i) {
    world.hold(std::max(left, 1 - static_cast<double>(i) / frames));
    world.step();
    if (i != frames + 90) continue;
    for (std::size_t k = 0; k < world.surface.vertices.size(); ++k) before.push_back(world.position(k));
  }
  Held held;
  for (std::size_t k = 0; k < before.size(); ++k)
    held.moved = std::max(held.moved, (world.position(k) - before[k]).norm());
  held.fastest = world.fastest();
  return held;
}
Held pullOpposite(Cinch& world, double seconds, double left) {
  return pullTogether(world, world.patch({0, 0, 0.02}, 7), world.patch({0, 0, -0.02}, 7), seconds, left);
}
void letGo(Cinch& world) {
  world.loads.constraints.clear();
  for (int i = 0; i < 60; ++i) world.step();
}

TEST(SelfContactCinch, WithoutItWallsPassThroughEachOther) {
  Cinch world(kFlat, 4, false);
  pullOpposite(world, 1, 0);
  EXPECT_GT(world.meetings, 100);
}

class SelfContactPull : public ::testing::TestWithParam<double> {};

// to 1 mm, two walls squeezed to less than half, slowly and in one frame
TEST_P(SelfContactPull, WallsMeetComeToRestAndPart) {
  Cinch world(kFlat, 4, true);
  const Held held = pullOpposite(world, GetParam(), 0.025);
  EXPECT_TRUE(world.finite);
  EXPECT_GT(world.pairs, 20);
  EXPECT_NEAR(world.distanceLeft(), 1e-3, 5e-5);
  EXPECT_GT(-world.loads.constraints[2].force, 1.0) << "the walls do not resist";
  EXPECT_LT(held.moved, 1e-4 * kLength);
  EXPECT_LT(held.fastest, 1e-4);
  letGo(world);
  EXPECT_EQ(world.meetings, 0);
  EXPECT_LT(world.fromRest(), 1e-4 * kLength);
}
INSTANTIATE_TEST_SUITE_P(Seconds, SelfContactPull, ::testing::Values(1.0, 0.1, 0.0));

// No two walls can be in one place: they are squeezed to a twentieth, and stop there.
TEST(SelfContactCinch, WhatCannotBeReachedIsNotPassed) {
  for (const double seconds : {1.0, 0.0}) {
    Cinch world(kFlat, 4, true);
    pullOpposite(world, seconds, 0);
    EXPECT_TRUE(world.finite);
    letGo(world);
    EXPECT_EQ(world.meetings, 0) << seconds;
    EXPECT_LT(world.fromRest(), 1e-3 * kLength) << seconds;
  }
}

// Two bites 50 mm apart in one wall: it folds between them.
Held fold(Cinch& world) {
  return pullTogether(world, world.patch({0.025, 0, 0.0156}, 7), world.patch({-0.025, 0, 0.0156}, 7), 1, 0.025);
}
TEST(SelfContactCinch, AFoldMeetsItself) {
  Cinch world(kFlat, 4, true), control(kFlat, 4, false);
  const Held held = fold(world);
  EXPECT_GT(world.pairs, 10);
  EXPECT_LT(held.moved, 1e-4 * kLength);
  EXPECT_LT(held.fastest, 1e-4);
  letGo(world);
  EXPECT_EQ(world.meetings, 0);
  EXPECT_LT(world.fromRest(), 1e-4 * kLength);
  fold(control);
  EXPECT_GT(control.meetings, 100);
}

// A patch is put 70 mm away in one frame, far on the other side of the opposite wall, and held there.
void throwAcross(Cinch& world) {
  world.put(world.patch({0, 0, 0.02}, 7), {0, 0, -0.07});
  for (int i = 0; i < 30; ++i) world.step();
}
TEST(SelfContactCinch, AWallThrownAtAnotherStopsBeforeIt) {
  Cinch world(kFlat, 4, true), control(kFlat, 4, false);
  throwAcross(world);
  EXPECT_TRUE(world.finite);
  EXPECT_GT(world.stopped, 0);
  EXPECT_GT(world.pairs, 50);
  letGo(world);
  EXPECT_EQ(world.meetings, 0);
  EXPECT_LT(world.fromRest(), 1e-4 * kLength);
  throwAcross(control);
  EXPECT_GT(control.meetings, 1000);
}

TEST(SelfContactCinch, DependsOnNothingButTheState) {
  Cinch one(kFlat, 3, true), other(kFlat, 3, true);
  for (Cinch* world : {&one, &other}) world->thread(world->patch({0, 0, 0.02}, 7), world->patch({0, 0, -0.02}, 7));
  for (int i = 1; i <= 90; ++i) {
    for (Cinch* world : {&one, &other}) {
      world->hold(std::max(0.02, 1 - i / 40.0));
      world->step();
    }
    other.forget();
    ASSERT_EQ(one.motion->x, other.motion->x) << "step " << i;
  }
  EXPECT_GT(one.pairs, 0);
}

}  // namespace
}  // namespace vibe::self_contact_cinch_test
