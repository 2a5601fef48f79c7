// What the lens has seen: against closed forms in a ball, against all rays, and through a session.
#include "vibe_core/simulation/wall_coverage.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "geometry/ray.hpp"
#include "vibe_core/simulation/simulation.hpp"
#include "vibe_core/simulation/tool_queries.hpp"
#include "vibe_testing/scope_worlds.hpp"

namespace vibe::wall_coverage_test {
namespace {

using Eigen::Vector3d;

constexpr double kRadius = 0.08;
const Vector3d kLensInTip(0, 0, 2.5e-3);  // in the URDF
constexpr double kDegree = M_PI / 180;

/// A ball of 10 * 4^level + 2 particles with the scope, half of whose particles are in the fundus; nothing is held.
std::shared_ptr<const Model> ball(int level, double fold = 0) {
  Scene scene = test::bareScene();
  scene.scope = test::scopeFromAbove(kRadius);
  Organ organ = test::plainOrgan(test::icosphere(kRadius, level), 2e-3);
  for (std::size_t i = 0; i < organ.region.size(); ++i) {
    Vector3d& p = organ.surface.vertices[i];
    if (p.z() > 0) organ.region[i] = Region::Fundus;
    const double height = fold * std::exp(-std::pow(p.z() / (0.12 * kRadius), 2));
    if (p.x() < 0) p *= 1 - height * std::min(1.0, -2 * p.x() / kRadius);
  }
  return test::scopeWorld(scene, std::move(organ)).model;
}

std::shared_ptr<const Model> plainBall() {
  static const std::shared_ptr<const Model> model = ball(4);
  return model;
}

/// A wall at rest, as the lens takes it.
struct Wall {
  explicit Wall(const Model& model) : triangles(model.organ.surface.triangles) {
    for (const Vector3d& p : model.organ.surface.vertices) x.push_back(p.x()), y.push_back(p.y()), z.push_back(p.z());
  }
  SurfaceView view() const { return {triangles, x, y, z}; }

  const std::vector<std::array<int, 3>>& triangles;
  std::vector<double> x, y, z;
};

/// The tip whose lens is at a place and looks along a direction.
Eigen::Isometry3d tipWithLens(const Vector3d& lens, const Vector3d& ahead) {
  Eigen::Isometry3d tip = Eigen::Isometry3d::Identity();
  tip.linear() = Eigen::Quaterniond::FromTwoVectors(Vector3d::UnitX(), ahead).toRotationMatrix();
  tip.translation() = lens - tip.linear() * kLensInTip;
  return tip;
}

InspectionScene narrow(double field_of_view, double distance = 1) {
  InspectionScene inspection;
  inspection.field_of_view = field_of_view;
  inspection.distance = distance;
  return inspection;
}

double shareSeen(const Model& model, const InspectionScene& inspection, const Vector3d& lens, const Vector3d& ahead) {
  WallCoverage coverage(model, inspection);
  coverage.look(tipWithLens(lens, ahead), Wall(model).view(), 1);
  return *coverage.shares().whole;
}

TEST(WallCoverage, FromTheCentreOfABallIsTheCapOfTheCone) {
  for (const int level : {3, 4}) {
    const auto model = ball(level);
    for (const double half : {10 * kDegree, 20 * kDegree})
      for (const Vector3d& ahead : {Vector3d(1, 0, 0), Vector3d(-0.3, 0.5, -0.8)}) {
        const double seen = shareSeen(*model, narrow(2 * half), Vector3d::Zero(), ahead.normalized());
        EXPECT_NEAR(seen, (1 - std::cos(half)) / 2, level == 3 ? 0.006 : 0.003) << half << " level " << level;
      }
  }
}

TEST(WallCoverage, EndsAtItsDistance) {
  const double aside = 0.3 * kRadius, distance = 0.72 * kRadius;  // the cap within it ends 25 degrees from the axis
  const double least = (kRadius * kRadius + aside * aside - distance * distance) / (2 * kRadius * aside);
  const Vector3d lens(0, 0, -aside), ahead(0, 0, -1);
  EXPECT_NEAR(shareSeen(*plainBall(), narrow(60 * kDegree, distance), lens, ahead), (1 - least) / 2, 0.0015);
  EXPECT_GT(shareSeen(*plainBall(), narrow(60 * kDegree), lens, ahead), 1.3 * (1 - least) / 2) << "control";
}

TEST(WallCoverage, TheDeviceHidesPartOfAWideView) {
  const double open = (1 - std::cos(70 * kDegree)) / 2;
  const double seen = shareSeen(*plainBall(), InspectionScene{}, Vector3d::Zero(), Vector3d::UnitX());
  EXPECT_GT(seen, 0.75 * open);
  EXPECT_LT(seen, 0.98 * open);
}

TEST(WallCoverage, TheOutsideOfAWallIsNotSeen) {
  const Vector3d outside(7e-3, 4e-3, -2 * kRadius);
  EXPECT_EQ(shareSeen(*plainBall(), narrow(40 * kDegree), outside, Vector3d::UnitZ()), 0);
  EXPECT_EQ(shareSeen(*plainBall(), narrow(40 * kDegree), outside, -Vector3d::UnitZ()), 0) << "turned away";
  EXPECT_GT(shareSeen(*plainBall(), narrow(40 * kDegree), Vector3d::Zero(), -Vector3d::UnitZ()), 0.02) << "control";
}

// Every ray against every triangle.
std::set<int> seenByAllRays(const Model& model, const Wall& wall, const Vector3d& lens, const Vector3d& ahead,
                            double half, bool through_walls) {
  std::set<int> seen;
  const std::vector<Vector3d> normal = vertexNormals(model.organ.surface);
  for (int i = 0; i < model.particle_count; ++i) {
    const Vector3d way = wall.view().position(i) - lens, direction = way.normalized();
    if (direction.dot(ahead) < std::cos(half) || direction.dot(normal[i]) < std::cos(75 * kDegree)) continue;
    const RayHit hit = firstHit(Ray(lens, direction, way.norm() - model.particle_radius), wall.view());
    if (through_walls || hit.triangle < 0) seen.insert(i);
  }
  return seen;
}

TEST(WallCoverage, AFoldHidesWhatIsBehindIt) {
  const auto model = ball(4, 0.6);
  const Wall wall(*model);
  const Vector3d lens(0.02 * kRadius, 0.03 * kRadius, 0.5 * kRadius), ahead = Vector3d(-0.45, 0, -0.9).normalized();
  const double half = 24 * kDegree;
  InspectionLens sight(*model, narrow(2 * half));
  const std::vector<int>& found = sight.look(tipWithLens(lens, ahead), wall.view(), std::vector<char>(wall.x.size()));
  const std::set<int> seen(found.begin(), found.end());
  EXPECT_EQ(seen, seenByAllRays(*model, wall, lens, ahead, half, false));
  const std::size_t through = seenByAllRays(*model, wall, lens, ahead, half, true).size();
  EXPECT_LT(seen.size() + 20, through) << "control: something is behind the fold";
  EXPECT_GT(seen.size(), 20u);
}

TEST(WallCoverage, SharesAreOfTheRegionAndLeaveOutTheEnds) {
  auto model = std::make_shared<Model>(*plainBall());
  WallCoverage all(*model, narrow(40 * kDegree));
  const Wall wall(*model);
  all.look(tipWithLens(Vector3d::Zero(), Vector3d::UnitZ()), wall.view(), 2.5);
  const CoverageSkill shares = all.shares();
  EXPECT_NEAR(*shares.region[static_cast<int>(Region::Fundus)], 2 * *shares.whole, 0.04);
  EXPECT_EQ(*shares.region[static_cast<int>(Region::Body)], 0);
  EXPECT_FALSE(shares.region[static_cast<int>(Region::Antrum)]) << "it has none";
  for (const float time : all.firstSeen()) EXPECT_TRUE(std::isnan(time) || time == 2.5F);
  for (std::size_t i = 0; i < wall.z.size(); ++i)
    if (wall.z[i] < 0.5 * kRadius) model->organ.end[i] = End::Duodenum;
  WallCoverage cap(*model, narrow(40 * kDegree));
  cap.look(tipWithLens(Vector3d::Zero(), Vector3d::UnitZ()), wall.view(), 0);
  EXPECT_NEAR(*cap.shares().whole, *shares.whole * 4, 0.02) << "of a quarter of the ball";
}

/// A session of a ball in which the scope goes in and turns.
std::shared_ptr<const Model> sessionModel(bool inspected, double step_period = 1.0 / 60) {
  Scene scene = test::bareScene();
  scene.step_period = step_period;
  scene.scope = test::scopeFromAbove(kRadius);
  if (inspected) scene.inspection.emplace();
  return test::scopeWorld(scene, test::openBall(kRadius, 3, 2e-3)).model;
}

StepInput turning(double time) {
  StepInput input;
  input.joints[Insertion] = 0.04 + 0.02 * time;
  input.joints[TipUpDown] = time;
  return input;
}

TEST(WallCoverage, GrowsInASessionThatItDoesNotChange) {
  Simulation looked(sessionModel(true)), plain(sessionModel(false));
  double last = 0;
  for (int k = 0; k < 90; ++k) {
    looked.step(turning(looked.time()));
    plain.step(turning(plain.time()));
    ASSERT_GE(*looked.metrics().coverage.whole, last);
    last = *looked.metrics().coverage.whole;
  }
  EXPECT_GT(last, 0.2);
  EXPECT_LT(last, 1);
  EXPECT_EQ(looked.hash(), plain.hash());
  EXPECT_EQ(plain.coverage(), nullptr);
  EXPECT_FALSE(plain.metrics().coverage.whole);
}

TEST(WallCoverage, IsTheSameAgainAndForgetsWithTheState) {
  Simulation first(sessionModel(true)), second(first.sharedModel());
  const auto run = [](Simulation& simulation) {
    for (int k = 0; k < 45; ++k) simulation.step(turning(simulation.time()));
    std::vector<double> seen;  // NaN is not equal to itself
    for (const float time : simulation.coverage()->firstSeen()) seen.push_back(std::isnan(time) ? -1 : time);
    return seen;
  };
  const std::vector<double> seen = run(first);
  EXPECT_EQ(run(second), seen);
  first.reset();
  EXPECT_EQ(*first.metrics().coverage.whole, 0);
  EXPECT_EQ(run(first), seen);
}

TEST(WallCoverage, DependsLittleOnTheStep) {
  const auto seenWith = [](double period) {
    Simulation simulation(sessionModel(true, period));
    while (simulation.time() < 1.5 - 1e-9) simulation.step(turning(simulation.time()));
    return *simulation.metrics().coverage.whole;
  };
  EXPECT_NEAR(seenWith(1.0 / 60), seenWith(1.0 / 240), 0.02);
}

}  // namespace
}  // namespace vibe::wall_coverage_test
