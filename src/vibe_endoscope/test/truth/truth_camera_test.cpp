// Depth, normals and labels against a sphere that is known exactly, and against an independent caster of rays.

#include "truth/truth_camera.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "truth/truth_worlds.hpp"

namespace vibe::endoscope::truth_camera_test {
namespace {

using test::FoldedWorld;
using test::kFar;
using test::kNear;
using test::PlainHit;
using test::PlainSurface;

constexpr double kRadius = 0.05;  // of the sphere [m]

double median(std::vector<double> values) {
  std::nth_element(values.begin(), values.begin() + static_cast<long>(values.size() / 2), values.end());
  return values[values.size() / 2];
}

/// Depth [m] of a sphere around the origin, seen from inside.
double sphereDepth(const Eigen::Isometry3d& pose, const Eigen::Vector3d& ray) {
  const Eigen::Vector3d o = pose.translation(), d = pose.linear() * ray;
  const double along = o.dot(d);
  return (-along + std::sqrt(along * along - o.squaredNorm() + kRadius * kRadius)) * ray.z();
}

class TruthCameraTest : public ::testing::TestWithParam<graphics::LensKind> {};

TEST_P(TruthCameraTest, DepthAndNormalsOfASphereAreThoseOfItsEquation) {
  graphics::TissueMesh mesh = graphics::test::ballMesh(250, 500);
  graphics::TissueFrame frame;
  for (const float p : mesh.rest) frame.positions.push_back(static_cast<float>(kRadius) * p);
  TruthScene scene;
  scene.setMesh(mesh);
  scene.setFrame(frame);
  scene.commit();
  const TruthCamera camera(test::smallCamera(GetParam()), kNear, kFar);
  const TruthCamera other(
      test::smallCamera(GetParam() == graphics::LensKind::Equidistant ? graphics::LensKind::Rectilinear
                                                                      : graphics::LensKind::Equidistant),
      kNear, kFar);
  TruthView view, wrong;
  camera.look(scene, test::eye(), view);
  other.look(scene, test::eye(), wrong);
  const std::vector<float> depth = camera.depth(scene, view), normals = camera.normals(scene, view);
  const std::vector<float> control = other.depth(scene, wrong);
  const int width = camera.round().width;
  std::vector<double> errors, angles, controls;
  for (std::size_t k = 0; k < depth.size(); ++k) {
    const Eigen::Vector2d pixel(static_cast<int>(k) % width, static_cast<int>(k) / width);
    const bool inside = (pixel - camera.round().middle()).norm() <= camera.round().radius();
    ASSERT_EQ(std::isfinite(depth[k]), inside) << pixel.transpose();  // a closed surface: the whole circle
    if (!inside) continue;
    const Eigen::Vector3d ray = graphics::rayOf(camera.round(), pixel);
    const double expected = sphereDepth(test::eye(), ray);
    errors.push_back(std::abs(double(depth[k]) - expected));
    controls.push_back(std::abs(double(control[k]) - expected));
    const Eigen::Vector3d place = test::eye() * Eigen::Vector3d(expected / ray.z() * ray);
    const Eigen::Vector3d normal = -(test::eye().linear().transpose() * place.normalized());
    angles.push_back(
        std::acos(std::min(1.0, normal.dot(Eigen::Map<const Eigen::Vector3f>(&normals[3 * k]).cast<double>()))));
  }
  const double largest = *std::max_element(errors.begin(), errors.end());
  std::printf("depth: median %.2g m, max %.2g m; normal: max %.2g rad\n", median(errors), largest,
              *std::max_element(angles.begin(), angles.end()));
  EXPECT_LT(largest, 5e-6);  // the triangles are 4 um inside of the sphere at most
  EXPECT_LT(*std::max_element(angles.begin(), angles.end()), 2e-3);
  EXPECT_GT(median(controls), 1e-4);  // control: the rays of the other lens are wrong
}

/// Depth along the axis by the independent caster; NaN where nothing is hit.
double plainDepth(const PlainSurface& surface, const graphics::RoundCamera& round, const Eigen::Isometry3d& pose,
                  const Eigen::Vector2d& pixel) {
  const auto hit = test::plainHit(surface, round, pose, pixel);
  return hit ? hit->distance * graphics::rayOf(round, pixel).z() : std::numeric_limits<double>::quiet_NaN();
}

TEST_P(TruthCameraTest, DepthIsThatOfTheIndependentCasterAndSilhouettesAreWithinHalfAPixel) {
  FoldedWorld world(24, 48);
  world.show(0.4);
  const PlainSurface surface = test::plainWorld(world, 0.4);
  const graphics::RoundCamera round = test::smallCamera(GetParam());
  const TruthCamera camera(round, kNear, kFar);
  TruthView view;
  camera.look(world.scene, test::eye(), view);
  const std::vector<float> depth = camera.depth(world.scene, view);
  std::vector<double> errors, controls;
  int silhouettes = 0, beyond = 0;
  Eigen::Isometry3d beside = test::eye();
  beside.translate(Eigen::Vector3d(0.0005, 0, 0.0005));
  for (std::size_t k = 0; k < depth.size(); ++k) {
    if (!std::isfinite(depth[k])) continue;
    const Eigen::Vector2d pixel(static_cast<int>(k) % round.width, static_cast<int>(k) / round.width);
    const double found = double(depth[k]);
    errors.push_back(std::abs(found - plainDepth(surface, round, test::eye(), pixel)));
    if (k % 7 == 0) controls.push_back(std::abs(found - plainDepth(surface, round, beside, pixel)));
    if (errors.back() < 1e-4) continue;
    // another body: then the silhouette between the two must be within half a pixel
    ++silhouettes;
    bool near = false;
    for (const auto& [x, y] : {std::pair(0.5, 0.), {-0.5, 0.}, {0., 0.5}, {0., -0.5}})
      near = near || std::abs(found - plainDepth(surface, round, test::eye(), pixel + Eigen::Vector2d(x, y))) < 1e-3;
    beyond += near ? 0 : 1;
  }
  std::printf("%zu pixels: median %.2g m, %d at silhouettes, %d of them beyond half a pixel\n", errors.size(),
              median(errors), silhouettes, beyond);
  EXPECT_GT(errors.size(), 8000u);
  EXPECT_LT(median(errors), 1e-7);  // required: 1e-4
  EXPECT_LE(silhouettes, static_cast<int>(errors.size() / 2000));
  EXPECT_EQ(beyond, 0);
  EXPECT_GT(median(controls), 1e-4);  // control: from 0.7 mm beside, the same depth is wrong
}

/// The label of an independent hit: region and wall of the nearest corner by the shares of its particles.
std::uint8_t plainLabel(const FoldedWorld& world, const PlainHit& hit) {
  const graphics::TissueMesh& mesh = world.mesh();
  const std::size_t wall_triangles = mesh.triangles.size() / 3;
  if (hit.triangle >= wall_triangles)
    return static_cast<std::uint8_t>(hit.triangle < wall_triangles + test::rodShape().triangles.size() / 3 ? 128 : 129);
  double heat = 0;
  int nearest = 0;
  hit.weight.maxCoeff(&nearest);
  double region[5] = {}, wall[4] = {};
  for (int c = 0; c < 3; ++c) {
    const std::uint32_t v = mesh.triangles[3 * hit.triangle + static_cast<std::size_t>(c)];
    for (std::uint32_t k = mesh.render_offsets[v]; k < mesh.render_offsets[v + 1]; ++k) {
      const double weight = double(mesh.render_weights[k]);
      heat += hit.weight[c] * weight * world.frame.grade[mesh.render_particles[k]];
      if (c != nearest) continue;
      region[mesh.region[mesh.render_particles[k]]] += weight;
      wall[mesh.wall[mesh.render_particles[k]]] += weight;
    }
  }
  const auto r = std::max_element(region, region + 5) - region, w = std::max_element(wall, wall + 4) - wall;
  return static_cast<std::uint8_t>(1 + 20 * std::lround(heat) + 4 * r + w);
}

TEST_P(TruthCameraTest, LabelsAgreeWithTheGeometryInMoreThan999Of1000Pixels) {
  FoldedWorld world(24, 48);
  world.show(0.4);
  world.scene.setSutures({}, 0, Eigen::Isometry3d::Identity());
  world.scene.commit();
  const PlainSurface surface = test::plainWorld(world, 0.4, false);
  const graphics::RoundCamera round = test::smallCamera(GetParam());
  const TruthCamera camera(round, kNear, kFar);
  TruthView view;
  camera.look(world.scene, test::eye(), view);
  const std::vector<std::uint8_t> labels = camera.labels(world.scene, view);
  int same = 0, all = 0, same_as_neighbour = 0;
  std::array<int, 256> seen{};
  for (int y = 0; y < round.height; ++y)
    for (int x = 0; x < round.width; ++x) {
      const std::uint8_t label = labels[static_cast<std::size_t>(y * round.width + x)];
      if (label == kLabelNothing) continue;
      const auto hit = test::plainHit(surface, round, test::eye(), {x, y});
      const std::uint8_t expected = hit ? plainLabel(world, *hit) : kLabelNothing;
      ++all, ++seen[label];
      same += label == expected;
      same_as_neighbour += labels[static_cast<std::size_t>(y * round.width + x + 3)] == expected;
    }
  std::printf("%d of %d labels agree, shifted by 3 px: %d\n", same, all, same_as_neighbour);
  EXPECT_GE(same, 0.999 * all);
  EXPECT_LT(same_as_neighbour, 0.97 * all);  // control
  EXPECT_GT(seen[128], 50);
  EXPECT_GT(seen[129], 50);
  EXPECT_GT(std::count_if(seen.begin(), seen.begin() + 21, [](int n) { return n > 20; }), 5);      // walls and regions
  EXPECT_GT(std::count_if(seen.begin() + 21, seen.begin() + 61, [](int n) { return n > 5; }), 0);  // heat
}

TEST_P(TruthCameraTest, OuterWallAndWhatIsTooNearAreToldApart) {
  FoldedWorld world(24, 48, false);
  world.show(0);
  const TruthCamera camera(test::smallCamera(GetParam()), kNear, kFar);
  Eigen::Isometry3d outside = test::eye();
  outside.translation() = Eigen::Vector3d(-0.2, 0, 0);
  TruthView view;
  camera.look(world.scene, outside, view);
  const std::vector<std::uint8_t> labels = camera.labels(world.scene, view);
  const int width = camera.round().width, height = camera.round().height;
  EXPECT_EQ(labels[static_cast<std::size_t>(height / 2 * width + width / 2)], kLabelOuterWall);
  EXPECT_EQ(labels[static_cast<std::size_t>(height / 2 * width + width / 2 - height / 2 + 3)], kLabelNothing);

  // the device is cut where it is nearer than the camera draws, the wall is not
  const auto middle = [&](double near) {
    const TruthCamera cutting(test::smallCamera(GetParam()), near, kFar);
    cutting.look(world.scene, outside, view);
    return cutting.labels(world.scene, view)[static_cast<std::size_t>(height / 2 * width + width / 2)];
  };
  EXPECT_EQ(middle(0.2), kLabelOuterWall);
  graphics::ColouredShape plate;
  graphics::appendBox(Eigen::Isometry3d::Identity(), {0.05, 0.05, 0.002}, 0, plate);
  const std::uint32_t part = world.scene.addPart("plate", plate);
  world.scene.placePart(part, outside * Eigen::Translation3d(0, 0, 0.03));
  world.scene.commit();
  EXPECT_GE(middle(0.02), kLabelInstrument);
  EXPECT_EQ(middle(0.04), kLabelOuterWall);
}

TEST_P(TruthCameraTest, AWallBehindTheLensLiesOnIt) {
  FoldedWorld world(96, 192, false);  // as fine as a drawn stomach
  world.show(0);
  const TruthCamera camera(test::smallCamera(GetParam()), kNear, kFar);
  const auto middle =
      static_cast<std::size_t>(camera.round().height / 2 * camera.round().width + camera.round().width / 2);
  const auto look = [&](const Eigen::Isometry3d& pose) {
    world.scene.pressOnLens(pose);
    world.scene.commit();
    TruthView view;
    camera.look(world.scene, pose, view);
    return std::pair(camera.depth(world.scene, view)[middle], camera.labels(world.scene, view)[middle]);
  };
  const auto [distance, inner] = look(test::eye());
  const auto at = [&](double before_wall) {
    return test::eye() * Eigen::Isometry3d(Eigen::Translation3d(0, 0, double{distance} - before_wall));
  };
  EXPECT_NEAR(look(at(0.002)).first, 0.002, 3e-4);  // the wall is inclined
  for (const double behind : {0.0, 5e-4, 2e-3}) {
    EXPECT_NEAR(look(at(-behind)).first, 1e-4, 1e-6) << behind;
    EXPECT_EQ(look(at(-behind)).second, inner) << behind;
  }
  EXPECT_NE(look(at(-0.006)).second, inner);     // control: a lens that is outside
  EXPECT_EQ(look(test::eye()).first, distance);  // and the wall is where it was
}

TEST_P(TruthCameraTest, ThreadsAndTagsHaveTheirLabelsAndThinBloodIsTransparent) {
  FoldedWorld world(24, 48, false);
  world.show(0);
  graphics::SutureDrawing sutures = test::thread(0);
  sutures.wounds.push_back({{0.035, 0.008, -0.004}, -Eigen::Vector3d::UnitX(), false, 1e-8, 4e-7, 3, 0});
  world.scene.setSutures(sutures, 1, Eigen::Isometry3d::Identity());
  world.scene.commit();
  const TruthCamera camera(test::smallCamera(GetParam(), 320, 240), kNear, kFar);
  TruthView view;
  camera.look(world.scene, test::eye(), view);
  std::array<int, 256> seen{};
  for (const std::uint8_t label : camera.labels(world.scene, view)) ++seen[label];
  EXPECT_GT(seen[kLabelThread], 10);
  EXPECT_GT(seen[kLabelTag], 5);
  EXPECT_EQ(seen[kLabelCinch], 0);
  EXPECT_GT(seen[kLabelBlood], 50);
  // blood that is half as strong has fewer visible pixels, since its rim is lost first; the number is then that of none
  sutures.wounds.clear();
  world.scene.setSutures(sutures, 1, Eigen::Isometry3d::Identity());
  world.scene.commit();
  camera.look(world.scene, test::eye(), view);
  const std::vector<std::uint8_t> labels = camera.labels(world.scene, view);
  EXPECT_EQ(std::count(labels.begin(), labels.end(), kLabelBlood), 0);
}

INSTANTIATE_TEST_SUITE_P(Lenses, TruthCameraTest,
                         ::testing::Values(graphics::LensKind::Equidistant, graphics::LensKind::Rectilinear),
                         test::lensName);

}  // namespace
}  // namespace vibe::endoscope::truth_camera_test
