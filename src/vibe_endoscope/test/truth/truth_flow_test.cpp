// Optical flow of a moving wall and of moving bodies, seen by a moving camera, against points of the material.

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "truth/truth_worlds.hpp"

namespace vibe::endoscope::truth_flow_test {
namespace {

using test::FoldedWorld;
using test::kFar;
using test::kNear;
using test::PlainSurface;

constexpr double kStep = 0.6;  // of the time of the folded world from image to image; moves the image by 1 to 2 px

class TruthFlowTest : public ::testing::TestWithParam<graphics::LensKind> {
 protected:
  TruthFlowTest() : round_(test::smallCamera(GetParam())), camera_(round_, kNear, kFar), world_(24, 48) {}

  /// Looks at the world, lets time pass and asks where everything went.
  TruthFlow flowOfOneStep() {
    // the tree of the triangles is made with the first two and keeps its order in the steps that are looked at
    for (const double earlier : {0.1, 0.2}) {
      world_.show(earlier);
      world_.scene.commit();
    }
    world_.show(0);
    before_ = test::plainWorld(world_, 0);
    camera_.look(world_.scene, test::eye(0), view_);
    world_.show(kStep);
    after_ = test::plainWorld(world_, kStep);
    return camera_.flow(view_, world_.scene, test::eye(kStep));
  }

  /// Where the material of a triangle is after the step.
  Eigen::Vector3d materialAfter(std::size_t triangle, const Eigen::Vector3d& weight) const {
    return weight[0] * after_.corners[3 * triangle] + weight[1] * after_.corners[3 * triangle + 1] +
           weight[2] * after_.corners[3 * triangle + 2];
  }
  bool isHidden(const Eigen::Vector3d& place) const {
    const Eigen::Vector3d from = test::eye(kStep).translation(), ray = place - from;
    const double distance = ray.norm();
    return after_.firstHit(from, ray / distance, kNear, distance - 1e-6).has_value();
  }
  bool isInside(const Eigen::Vector2d& pixel, double margin = 0) const {
    return (pixel - round_.middle()).norm() <= round_.radius() - margin;
  }

  graphics::RoundCamera round_;
  TruthCamera camera_;
  FoldedWorld world_;
  PlainSurface before_, after_;
  TruthView view_;
};

TEST_P(TruthFlowTest, LeadsFromThePixelToItsMaterialPointAndTellsWhetherItIsVisible) {
  const TruthFlow flow = flowOfOneStep();
  double largest = 0, total = 0;
  int checked = 0, wrong_side = 0, wrong_visible = 0, hidden = 0, elsewhere = 0;
  for (int y = 0; y < round_.height; ++y)
    for (int x = 0; x < round_.width; ++x) {
      const auto k = static_cast<std::size_t>(y * round_.width + x);
      const Eigen::Vector2d motion = Eigen::Map<const Eigen::Vector2f>(&flow.motion[2 * k]).cast<double>();
      EXPECT_EQ(motion.allFinite(), flow.visible[k] != 0);
      const auto hit = isInside({x, y}) ? test::plainHit(before_, round_, test::eye(0), {x, y}) : std::nullopt;
      if (!hit) continue;
      const Eigen::Vector3d place = materialAfter(hit->triangle, hit->weight);
      const Eigen::Vector2d there = graphics::pixelOf(round_, test::eye(kStep).inverse() * place);
      if (isInside(there, 0.01) != motion.allFinite() && isInside(there, 0) == isInside(there, 0.02)) ++wrong_side;
      if (!motion.allFinite()) continue;
      const double error = (Eigen::Vector2d(x, y) + motion - there).norm();
      if (error > 0.01 && ++elsewhere > 0) continue;  // at a silhouette, the other side of it
      ++checked, total += motion.norm(), largest = std::max(largest, error);
      hidden += flow.visible[k] == TruthFlow::kHiddenNext;
      wrong_visible += (flow.visible[k] == TruthFlow::kHiddenNext) != isHidden(place);
    }
  std::printf(
      "%d pixels: mean motion %.2f px, max error %.2g px; %d hidden, %d wrongly; %d on the other side of a "
      "silhouette\n",
      checked, total / checked, largest, hidden, wrong_visible, elsewhere);
  EXPECT_GT(checked, 8000);
  EXPECT_GT(total / checked, 1);  // there is something to tell
  EXPECT_LT(largest, 0.01);       // required: 0.2
  EXPECT_LE(wrong_side, 8);
  EXPECT_LE(elsewhere, 3);
  EXPECT_GT(hidden, 20);
  EXPECT_LE(wrong_visible, checked / 1000);
}

// As a user would: a point of the wall anywhere in the image, and the flow interpolated between four pixels.
TEST_P(TruthFlowTest, WarpsFreePointsOfTheWallWithinAFifthOfAPixel) {
  const TruthFlow flow = flowOfOneStep();
  std::mt19937 random(7);
  std::uniform_real_distribution<double> share(0, 1);
  const std::size_t wall = world_.mesh().triangles.size() / 3;
  std::vector<double> errors, controls;
  for (int trial = 0; trial < 6000; ++trial) {
    const auto triangle = static_cast<std::size_t>(share(random) * static_cast<double>(wall));
    double u = share(random), v = share(random);
    if (u + v > 1) u = 1 - u, v = 1 - v;
    const Eigen::Vector3d weight(1 - u - v, u, v);
    Eigen::Vector3d place = Eigen::Vector3d::Zero();
    for (int c = 0; c < 3; ++c) place += weight[c] * before_.corners[3 * triangle + static_cast<std::size_t>(c)];
    const Eigen::Vector2d from = graphics::pixelOf(round_, test::eye(0).inverse() * place);
    if (!isInside(from, 2)) continue;
    const auto seen = test::plainHit(before_, round_, test::eye(0), from);
    if (!seen || (seen->place - place).norm() > 1e-6) continue;
    const Eigen::Vector2d to = graphics::pixelOf(round_, test::eye(kStep).inverse() * materialAfter(triangle, weight));
    const auto x = static_cast<int>(from.x()), y = static_cast<int>(from.y());
    Eigen::Vector2d motion = Eigen::Vector2d::Zero();
    bool visible = true;  // and all four on the wall
    for (int corner = 0; corner < 4; ++corner) {
      const int column = x + (corner & 1), row = y + (corner >> 1);
      const auto k = static_cast<std::size_t>(row * round_.width + column);
      const double part = (1 - std::abs(from.x() - column)) * (1 - std::abs(from.y() - row));
      motion += part * Eigen::Map<const Eigen::Vector2f>(&flow.motion[2 * k]).cast<double>();
      const auto hit = test::plainHit(before_, round_, test::eye(0), {column, row});
      visible = visible && flow.visible[k] == TruthFlow::kVisibleNext && hit && hit->triangle < wall &&
                std::abs(hit->distance - seen->distance) < 0.003;
    }
    if (!visible || !motion.allFinite()) continue;
    errors.push_back((from + motion - to).norm());
    controls.push_back((from - motion - to).norm());
  }
  std::sort(errors.begin(), errors.end());
  std::sort(controls.begin(), controls.end());
  ASSERT_GT(errors.size(), 800u);
  const std::size_t most = errors.size() * 99 / 100;
  std::printf("%zu points: median %.3f px, p99 %.3f px, max %.3f px\n", errors.size(), errors[errors.size() / 2],
              errors[most], errors.back());
  EXPECT_LT(errors[most], 0.2);
  EXPECT_GT(controls[controls.size() / 20], 0.2);  // control: the other way
}

TEST_P(TruthFlowTest, OfACameraThatStandsStillBeforeWhatStandsStillIsZero) {
  world_.show(0);
  camera_.look(world_.scene, test::eye(), view_);
  const TruthFlow flow = camera_.flow(view_, world_.scene, test::eye());
  double largest = 0;
  int visible = 0, told = 0;
  for (std::size_t k = 0; k < flow.visible.size(); ++k) {
    if (flow.visible[k] == 0) continue;
    ++told, visible += flow.visible[k] == TruthFlow::kVisibleNext;
    largest =
        std::max<double>({largest, std::abs(double(flow.motion[2 * k])), std::abs(double(flow.motion[2 * k + 1]))});
  }
  EXPECT_LT(largest, 1e-3);
  EXPECT_GT(told, 8000);
  EXPECT_GE(visible, 0.999 * told);
}

TEST_P(TruthFlowTest, IsNotToldOfWhatIsGoneOrHasOtherTriangles) {
  world_.show(0);
  camera_.look(world_.scene, test::eye(), view_);
  const std::vector<std::uint8_t> labels = camera_.labels(world_.scene, view_);
  world_.scene.placePart(5, std::nullopt);  // the rod
  graphics::SutureDrawing other = test::thread(0);
  other.sets[0].pieces[0].line.insert(other.sets[0].pieces[0].line.begin() + 1, {0.0245, 0.0015, 0.0128});
  world_.scene.setSutures(other, 0, Eigen::Isometry3d::Identity());
  world_.scene.commit();
  const TruthFlow flow = camera_.flow(view_, world_.scene, test::eye());
  int gone = 0;
  for (std::size_t k = 0; k < labels.size(); ++k) {
    if (labels[k] == kLabelInstrument || labels[k] == kLabelThread) {
      EXPECT_EQ(int{flow.visible[k]}, 0);
      ++gone;
    } else if (labels[k] == kLabelInstrument + 1) {
      EXPECT_NE(int{flow.visible[k]}, 0);
    }
  }
  EXPECT_GT(gone, 60);
}

// The pair of a stereo camera is flow without time.
TEST_P(TruthFlowTest, BetweenTwoLensesIsTheDisparityOfTheDepth) {
  constexpr double kBaseline = 0.004;
  world_.show(0);
  camera_.look(world_.scene, test::eye(), view_);
  TruthView right;
  const Eigen::Isometry3d aside = test::eye() * Eigen::Translation3d(kBaseline, 0, 0);
  camera_.look(world_.scene, aside, right);
  const std::vector<float> depth = camera_.depth(world_.scene, view_), seen = camera_.depth(world_.scene, right);
  const TruthFlow flow = camera_.flow(view_, world_.scene, aside);
  std::vector<double> errors, depths;
  for (std::size_t k = 0; k < depth.size(); ++k) {
    if (flow.visible[k] != TruthFlow::kVisibleNext) continue;
    const int x = static_cast<int>(k) % round_.width, y = static_cast<int>(k) / round_.width;
    const Eigen::Vector3d ray = graphics::rayOf(round_, {x, y});
    const Eigen::Vector3d place = double(depth[k]) / ray.z() * ray - Eigen::Vector3d(kBaseline, 0, 0);
    const Eigen::Vector2d there = graphics::pixelOf(round_, place);
    const Eigen::Vector2d motion = Eigen::Map<const Eigen::Vector2f>(&flow.motion[2 * k]).cast<double>();
    errors.push_back((Eigen::Vector2d(x, y) + motion - there).norm());
    if (GetParam() == graphics::LensKind::Rectilinear) {
      EXPECT_NEAR(double(flow.motion[2 * k]), -graphics::focalLength(round_) * kBaseline / double(depth[k]), 0.01);
    }
    const auto nearest = static_cast<std::size_t>(std::lround(there.y()) * round_.width + std::lround(there.x()));
    depths.push_back(std::abs(double(seen[nearest]) - double(depth[k])));
  }
  ASSERT_GT(errors.size(), 6000u);
  EXPECT_LT(*std::max_element(errors.begin(), errors.end()), 0.01);
  std::sort(depths.begin(), depths.end());
  EXPECT_LT(depths[depths.size() / 2], 3e-4);  // of the nearest pixel of the other image
}

INSTANTIATE_TEST_SUITE_P(Lenses, TruthFlowTest,
                         ::testing::Values(graphics::LensKind::Equidistant, graphics::LensKind::Rectilinear),
                         test::lensName);

}  // namespace
}  // namespace vibe::endoscope::truth_flow_test
