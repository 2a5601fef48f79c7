// Blood on analytic walls: where it goes, how much of it is where, and that it moves with wall and gravity.
#include "vibe_graphics/geometry/blood_flow.hpp"

#include <gtest/gtest.h>

#include "geometry/blood_on_wall.hpp"
#include "shape_measures.hpp"
#include "vibe_graphics/geometry/blood_shapes.hpp"
#include "walls.hpp"

namespace vibe::graphics::blood_flow_test {
namespace {

using Eigen::Vector3d;

Wound woundAt(double x, double y, double amount, bool brisk = false) {
  Wound wound;
  wound.place = {x, y, test::bowl(x, y)};
  wound.inward = Vector3d::UnitZ();
  wound.brisk = brisk;
  wound.rate = brisk ? 2.5e-7 : 1e-8;
  wound.amount = amount;
  wound.age = amount / wound.rate;
  return wound;
}

BloodStyle upright() {
  BloodStyle style;
  style.down = -Vector3d::UnitZ();
  return style;
}

const test::HeightWall& bowlWall() {
  static const test::HeightWall wall(91, 0.036, test::bowl);
  return wall;
}

double volumeOf(const BloodFlow& flow) {
  double sum = 0;
  for (const BloodFilm& film : flow.films) sum += film.volume;
  for (std::size_t k = 0; k + flow.passing < flow.rivulets.size(); ++k) sum += flow.rivulets[k].volume();
  for (const Pool& pool : flow.pools) sum += pool.volume;
  return sum;
}

ColouredShape shapeOf(const std::vector<Wound>& wounds, const WallSurface& wall, const BloodStyle& style) {
  SutureDrawing scene;
  scene.wounds = wounds;
  ColouredShape shape;
  appendBlood(scene, style, &wall, shape);
  return shape;
}

/// Largest distance of a vertex of `a`, moved by a pose, to the nearest one of `b`.
double farthestFrom(const ColouredShape& a, const ColouredShape& b, const Eigen::Isometry3d& pose) {
  double farthest = 0;
  for (std::size_t v = 0; v < a.vertices.size(); ++v) {
    double nearest = 1;
    for (std::size_t w = 0; w < b.vertices.size(); ++w)
      nearest = std::min(nearest, (pose * placeOf(a, v) - placeOf(b, w)).squaredNorm());
    farthest = std::max(farthest, std::sqrt(nearest));
  }
  return farthest;
}

TEST(BloodFlow, FilmsRivuletsAndPoolsAreWhatWasLost) {
  const WallSurface wall = bowlWall().surface();
  for (const bool brisk : {false, true})
    for (const double amount : {2e-9, 2e-8, 2e-7, 3e-6}) {
      const BloodFlow flow =
          flowOf({woundAt(0.02, 0.01, amount, brisk), woundAt(-0.01, -0.02, amount)}, wall, upright());
      EXPECT_NEAR(volumeOf(flow) / (2 * amount), 1, 1e-9) << amount << (brisk ? " brisk" : " mild");
      EXPECT_LE(flow.pools.size(), 1U);
      EXPECT_EQ(flow.jets.size(), brisk ? 1U : 0U);
    }
}

TEST(BloodFlow, RivuletGetsLongerWithTimeUntilItArrives) {
  const WallSurface wall = bowlWall().surface();
  double before = 0;
  bool arrived = false;
  for (double amount = 1e-8; amount < 2e-7; amount += 5e-9) {
    const BloodFlow flow = flowOf({woundAt(0.025, 0, amount)}, wall, upright());
    ASSERT_EQ(flow.rivulets.size(), 1U);
    const Rivulet& rivulet = flow.rivulets[0];
    EXPECT_GE(rivulet.length, before);
    EXPECT_TRUE(arrived || rivulet.arrived || rivulet.length > before + 1e-4);
    EXPECT_EQ(flow.pools.empty(), !rivulet.arrived || volumeOf(flow) == 0);
    before = rivulet.length, arrived = rivulet.arrived;
  }
  EXPECT_TRUE(arrived);
  EXPECT_NEAR(before, test::kBowlRadius * std::asin(0.025 / test::kBowlRadius), 1e-3);  // the arc to the bottom
  Wound sudden = woundAt(0.025, 0, 2e-7);
  sudden.age = 1;  // control: it cannot be there yet
  EXPECT_NEAR(flowOf({sudden}, wall, upright()).rivulets.at(0).length, 8e-3, 1e-6);
}

TEST(BloodFlow, PoolIsLevelAndItsShoreIsACircle) {
  const WallSurface wall = bowlWall().surface();
  const BloodFlow flow = flowOf({woundAt(0.02, 0.01, 3e-6)}, wall, upright());
  ASSERT_EQ(flow.pools.size(), 1U);
  ColouredShape shape;
  appendPool(flow.pools[0], wall, upright(), shape);
  ASSERT_TRUE(isSound(shape));
  const double height = test::capHeight(flow.pools[0].volume);
  const double radius = std::sqrt(height * (2 * test::kBowlRadius - height));
  double farthest = 0, area = 0;
  for (std::size_t v = 0; v < shape.vertices.size(); ++v) {
    const Vector3d p = placeOf(shape, v);
    EXPECT_NEAR(p.z(), placeOf(shape, 0).z(), 1e-7);
    EXPECT_GE(p.z(), test::bowl(p.x(), p.y()) - 1e-5);  // in the lumen
    farthest = std::max(farthest, p.head<2>().norm());
  }
  for (std::size_t t = 0; t < shape.triangles.size(); t += 3) {
    const Vector3d a = placeOf(shape, shape.triangles[t]), b = placeOf(shape, shape.triangles[t + 1]),
                   c = placeOf(shape, shape.triangles[t + 2]);
    area += 0.5 * (b - a).cross(c - a).z();
  }
  std::printf("radius %.2f mm, of the cap %.2f mm; area %.1f mm2, %.1f mm2\n", farthest * 1e3, radius * 1e3, area * 1e6,
              3.14159265 * radius * radius * 1e6);
  EXPECT_NEAR(farthest / radius, 1, 0.03);
  EXPECT_NEAR(area / (3.14159265 * radius * radius), 1, 0.03);
  EXPECT_NEAR(placeOf(shape, 0).z() / height, 1, 0.03);
}

TEST(BloodFlow, ShapesAreOnTheWallAndInTheLumen) {
  const WallSurface wall = bowlWall().surface();
  const ColouredShape shape = shapeOf({woundAt(0.025, 0.004, 6e-8)}, wall, upright());
  ASSERT_TRUE(isSound(shape));
  ASSERT_GT(shape.triangles.size(), 100U);
  for (std::size_t v = 0; v < shape.vertices.size(); ++v) {
    const Vector3d p = placeOf(shape, v);
    const double off = test::kBowlRadius - (p - Vector3d(0, 0, test::kBowlRadius)).norm();
    EXPECT_GT(off, -1e-6);  // 0 at the shore
    EXPECT_LT(off, 0.9e-3);
  }
}

/// The wall turned with gravity and wound, and moved: the same shapes there.
TEST(BloodFlow, MovesWithWallAndGravity) {
  test::HeightWall moved = bowlWall();
  moved.pose = Eigen::Translation3d(0.1, -0.05, 0.02) * Eigen::AngleAxisd(1.1, Vector3d(1, 2, -1).normalized());
  const WallSurface here = bowlWall().surface(), there = moved.surface();
  Wound wound = woundAt(0.025, 0.004, 2e-7);
  const ColouredShape first = shapeOf({wound}, here, upright());
  wound.place = moved.pose * wound.place, wound.inward = moved.pose.linear() * wound.inward;
  BloodStyle style;
  style.down = moved.pose.linear() * upright().down;
  const ColouredShape second = shapeOf({wound}, there, style);
  // the order of a pool's triangles may differ where heights are equal
  const double farthest =
      std::max(farthestFrom(first, second, moved.pose), farthestFrom(second, first, moved.pose.inverse()));
  const double apart = farthestFrom(first, second, Eigen::Isometry3d::Identity());
  std::printf("farthest from the same shape %.2g m\n", farthest);
  EXPECT_LT(farthest, 1e-5);
  EXPECT_GT(apart, 0.01);  // control: it has moved
}

TEST(BloodFlow, FlatCeilingKeepsAFilmAndTheRestFalls) {
  // a bowl below a flat ceiling that faces down
  const test::HeightWall& bowl = bowlWall();
  test::HeightWall both = bowl;
  const auto first = static_cast<std::uint32_t>(both.vertices.size());
  for (MovingVertex vertex : bowl.vertices) {
    vertex.position[2] = 0.05F, vertex.normal[0] = vertex.normal[1] = 0, vertex.normal[2] = 1;
    both.vertices.push_back(vertex);
  }
  for (std::size_t t = 0; t < bowl.triangles.size(); t += 3)
    for (const std::size_t k : {0, 2, 1}) both.triangles.push_back(first + bowl.triangles[t + k]);
  const WallSurface wall = both.surface();
  Wound wound = woundAt(0.01, 0, 2e-8);
  wound.place.z() = 0.05, wound.inward = -Vector3d::UnitZ();
  const BloodFlow little = flowOf({wound}, wall, upright());
  EXPECT_EQ(little.films.size(), 1U);
  EXPECT_TRUE(little.rivulets.empty() && little.pools.empty());
  wound.amount = 5e-7, wound.age = 50;
  const BloodFlow much = flowOf({wound}, wall, upright());
  ASSERT_EQ(much.films.size(), 2U);
  EXPECT_NEAR(std::max(much.films[0].at.place.z(), much.films[1].at.place.z()), 0.05, 1e-9);
  ASSERT_EQ(much.pools.size(), 1U);
  EXPECT_LT(much.pools[0].level, 0.02);
  EXPECT_NEAR(volumeOf(much) / 5e-7, 1, 1e-9);
}

TEST(BloodFlow, JetLandsOnTheWall) {
  const WallSurface wall = bowlWall().surface();
  const BloodFlow flow = flowOf({woundAt(0.02, 0.01, 1e-6, true)}, wall, upright());
  ASSERT_EQ(flow.jets.size(), 1U);
  const Vector3d end = jetPath(flow.jets[0].wound, flow.jets[0].duration, upright()).back();
  EXPECT_NEAR(end.z(), test::bowl(end.x(), end.y()), 3e-4);  // the path is met as a polygon
  EXPECT_GT((end - flow.jets[0].wound.place).norm(), 2e-3);
  EXPECT_GT(flow.jets[0].duration, 0.02);
}

TEST(BloodFlow, StoppedBloodIsBrownAndHasNoJet) {
  const WallSurface wall = bowlWall().surface();
  Wound wound = woundAt(0.02, 0.01, 1e-6, true);
  const BloodFlow bleeds = flowOf({wound}, wall, upright());
  wound.rate = 0;
  const BloodFlow stopped = flowOf({wound}, wall, upright());
  EXPECT_TRUE(stopped.jets.empty());
  ASSERT_EQ(stopped.pools.size(), 1U);
  EXPECT_GE(stopped.pools[0].brown, 0.5);
  EXPECT_EQ(bleeds.pools.at(0).brown, 0);
}

TEST(BloodFlow, WoundWithoutAWallIsDrawnAsBefore) {
  const WallSurface wall = bowlWall().surface();
  Wound wound = woundAt(0.02, 0.01, 1e-7);
  wound.place.z() += 0.1;
  SutureDrawing scene;
  scene.wounds = {wound};
  ColouredShape far, none;
  appendBlood(scene, upright(), &wall, far);
  appendBlood(scene, upright(), nullptr, none);
  ASSERT_FALSE(none.vertices.empty());
  EXPECT_EQ(far.triangles, none.triangles);
  EXPECT_NE(shapeOf({woundAt(0.02, 0.01, 1e-7)}, wall, upright()).triangles, none.triangles);  // control
}

TEST(BloodFlow, TrianglesWithoutAreaLeaveShapesFinite) {
  test::HeightWall form = bowlWall();
  for (std::uint32_t v = 0; v + 1 < form.vertices.size(); v += 7)
    form.triangles.insert(form.triangles.end(), {v, v, v + 1, v, v, v});
  const WallSurface wall = form.surface();
  EXPECT_TRUE(isSound(shapeOf({woundAt(0.02, 0.01, 3e-7), woundAt(0, 0.03, 1e-6, true)}, wall, upright())));
}

TEST(BleedingShape, IsMadeAgainOnlyIfSomethingHasChanged) {
  TissueMesh mesh;
  mesh.triangles = bowlWall().triangles, mesh.vertex_count = bowlWall().vertices.size();
  std::vector<MovingVertex> vertices = bowlWall().vertices;
  const Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  BleedingShape blood;
  blood.setMesh(&mesh);
  EXPECT_FALSE(blood.update(&vertices, pose));
  SutureDrawing scene;
  scene.wounds = {woundAt(0.02, 0.01, 1e-7)};
  blood.setWounds(scene, upright());
  EXPECT_TRUE(blood.update(&vertices, pose));
  EXPECT_FALSE(blood.update(&vertices, pose));
  const ColouredShape before = blood.shape();
  for (MovingVertex& vertex : vertices) vertex.position[2] += 1e-3F;
  EXPECT_TRUE(blood.update(&vertices, pose));
  EXPECT_GT(placeOf(blood.shape(), 0).z() - placeOf(before, 0).z(), 5e-4);
  EXPECT_TRUE(blood.update(nullptr, pose));  // as without a wall
  blood.setWounds({}, upright());
  EXPECT_TRUE(blood.update(&vertices, pose));
  EXPECT_TRUE(blood.shape().vertices.empty());
  EXPECT_FALSE(blood.update(&vertices, pose));
}

}  // namespace
}  // namespace vibe::graphics::blood_flow_test
