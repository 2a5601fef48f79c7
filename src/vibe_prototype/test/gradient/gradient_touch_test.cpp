#include "gradient/gradient_touch.hpp"

#include <gtest/gtest.h>
#include "vibe_testing/allocation_count.hpp"

#include <algorithm>
#include <cmath>

#include "vibe_testing/worlds.hpp"

namespace vibe::prototype::gradient_touch_test {
namespace {

using Eigen::Vector3d;

/// A wall and a round tool.
struct TouchedBall {
  SurfaceMesh mesh = test::icosphere(0.05, 4);
  std::vector<double> x, y, z;
  std::vector<double> out_x, out_y, out_z;
  GradientTouch touch{0.04, 1};
  Vector3d tool = Vector3d::Zero();
  double radius = 0.008;

  TouchedBall() {
    for (const Vector3d& p : mesh.vertices) x.push_back(p.x()), y.push_back(p.y()), z.push_back(p.z());
  }

  int update() {
    const auto find = [this](const auto& px, const auto& py, const auto& pz, std::vector<Touch>& touches) {
      for (int i = 0; i < static_cast<int>(px.size()); ++i) {
        const Vector3d from = Vector3d(px[i], py[i], pz[i]) - tool;
        if (from.norm() < radius * (1 - 1e-9)) touches.push_back({i, tool + radius * from.normalized()});
      }
    };
    return touch.update({mesh.triangles, x, y, z}, find, out_x, out_y, out_z);
  }
  Vector3d now(std::size_t i) const { return {out_x[i], out_y[i], out_z[i]}; }
  double deepest() const {
    double depth = 0;
    for (std::size_t i = 0; i < x.size(); ++i) depth = std::max(depth, radius - (now(i) - tool).norm());
    return depth;
  }
  double largestShift() const {
    double shift = 0;
    for (std::size_t i = 0; i < x.size(); ++i) shift = std::max(shift, (now(i) - mesh.vertices[i]).norm());
    return shift;
  }
};

TEST(GradientTouch, LeavesWhatIsNotTouched) {
  TouchedBall ball;
  EXPECT_EQ(ball.update(), 0);
  EXPECT_EQ(ball.out_x, ball.x);
  EXPECT_EQ(ball.out_y, ball.y);
  EXPECT_EQ(ball.out_z, ball.z);
}

TEST(GradientTouch, NothingStaysInsideTheTool) {
  TouchedBall ball;
  for (const double place : {0.044, 0.046, 0.048, 0.0495}) {
    ball.tool = place * Vector3d(0.6, 0.64, 0.48);
    EXPECT_GT(ball.update(), 0);
    EXPECT_LT(ball.deepest(), 2e-4) << place;
    EXPECT_LT(ball.largestShift(), place + 0.008 - 0.05 + 0.0015) << "as far as the tool pushes, and no farther";
    EXPECT_GT(ball.largestShift(), 0.8 * (place + 0.008 - 0.05));
  }
}

TEST(GradientTouch, SpringsBackAndForgets) {
  TouchedBall ball, fresh;
  ball.tool = fresh.tool = {0.048, 0, 0};
  ball.update();
  const auto first = ball.out_x;
  ball.tool = {0, 0.05, 0};
  ball.update();
  ball.tool = Vector3d::Zero();
  EXPECT_EQ(ball.update(), 0);
  EXPECT_EQ(ball.out_x, ball.x);
  ball.tool = {0.048, 0, 0};
  ball.update();
  EXPECT_EQ(ball.out_x, first);
  // another base under the same handles: nothing of the old one is used
  for (auto* b : {&ball, &fresh})
    for (double& value : b->z) value *= 1.05;
  ball.update();
  fresh.update();
  EXPECT_EQ(ball.out_x, fresh.out_x);
  EXPECT_EQ(ball.out_z, fresh.out_z);
  EXPECT_NE(ball.out_x, first);
}

TEST(GradientTouch, MovesSmoothlyWithTheTool) {
  // slid along the wall by 0.3 mm at a time; where another particle comes to be touched the shape jumps, but not far
  TouchedBall ball;
  std::vector<double> last;
  double largest = 0;
  for (int i = 0; i < 60; ++i) {
    const double angle = 0.006 * i;
    ball.tool = 0.046 * Vector3d(std::cos(angle), std::sin(angle), 0.1);
    ball.update();
    if (!last.empty())
      for (std::size_t p = 0; p < last.size(); ++p) largest = std::max(largest, std::abs(ball.out_x[p] - last[p]));
    last = ball.out_x;
  }
  EXPECT_LT(largest, 0.0015);
  EXPECT_GT(largest, 0);
}

TEST(GradientTouch, DoesNotAllocateWhileTheSameIsTouched) {
  if (!VIBE_COUNTS_ALLOCATIONS) GTEST_SKIP() << "a sanitizer brings its own memory";
  TouchedBall ball;
  const SurfaceView base{ball.mesh.triangles, ball.x, ball.y, ball.z};
  double distance = 0.002;
  const GradientTouch::FindTouches find = [&](const auto& x, const auto&, const auto&, std::vector<Touch>& touches) {
    if (x[7] == ball.x[7]) touches.push_back({7, ball.mesh.vertices[7] * (1 + distance / 0.05)});
  };
  ball.touch.update(base, find, ball.out_x, ball.out_y, ball.out_z);
  distance = 0.003;
  const long before = test::allocations;
  ball.touch.update(base, find, ball.out_x, ball.out_y, ball.out_z);
  EXPECT_EQ(test::allocations, before);
  EXPECT_NEAR((ball.now(7) - ball.mesh.vertices[7]).norm(), 0.003, 1e-12);
}

}  // namespace
}  // namespace vibe::prototype::gradient_touch_test
