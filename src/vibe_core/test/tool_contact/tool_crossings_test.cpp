#include "vibe_testing/tool_crossings.hpp"

#include <gtest/gtest.h>

#include "vibe_testing/scope_fixture.hpp"

namespace vibe::tool_crossings_test {
namespace {

using Eigen::Vector3d;
using namespace test;

struct Plate {
  std::vector<std::array<int, 3>> triangles{{0, 1, 2}};
  std::vector<double> x, y, z;
  Plate(const Vector3d& a, const Vector3d& b, const Vector3d& c)
      : x{a.x(), b.x(), c.x()}, y{a.y(), b.y(), c.y()}, z{a.z(), b.z(), c.z()} {}
  SurfaceView view() const { return {triangles, x, y, z}; }
};

/// A large triangle across the x axis.
Plate acrossX(double x) {
  return {{x, -1, -1}, {x, 1, -1}, {x, 0.1, 1}};
}

/// The endoscope's URDF with these shapes instead of its own, all in the root link, which is at the origin.
ToolModel toolOf(const std::string& shapes) {
  std::string text = scopeText();
  for (std::size_t from; (from = text.find("<collision>")) != std::string::npos;)
    text.erase(from, text.find("</collision>") + 12 - from);
  const std::string root = "<link name=\"scope_base\"/>";
  text.replace(text.find(root), root.size(), "<link name=\"scope_base\">" + shapes + "</link>");
  return ToolModel::fromUrdf(text, "test");
}

std::string shapeOf(const std::string& geometry, const std::string& place, const std::string& turn = "0 0 0") {
  return "<collision><origin xyz=\"" + place + "\" rpy=\"" + turn + "\"/><geometry>" + geometry +
         "</geometry></collision>";
}

const char kTurn[] = "0 1.5707963267948966 0";  // z into x
const std::string kSphere = "<sphere radius=\"0.005\"/>";

/// From x = -0.01 to x = 0.01 with a radius of 5 mm.
ToolModel capsule() {
  return toolOf(shapeOf("<cylinder radius=\"0.005\" length=\"0.02\"/>", "0 0 0", kTurn) +
                shapeOf(kSphere, "-0.01 0 0") + shapeOf(kSphere, "0.01 0 0"));
}

ToolCrossing crossing(const ToolModel& tool, const Plate& plate, const std::vector<char>& passes = {}) {
  const std::vector<Eigen::Isometry3d> poses(static_cast<std::size_t>(tool.linkCount()), Eigen::Isometry3d::Identity());
  return findToolCrossing(tool, poses, plate.view(), passes);
}

TEST(ToolCrossings, ACapsuleIsPiercedWhereItsAxisPassesThroughTheWall) {
  const ToolModel tool = capsule();
  ASSERT_EQ(tool.shapes().size(), 1u);
  const ToolCrossing middle = crossing(tool, acrossX(0.004));
  EXPECT_EQ(middle.pierced, 1);
  EXPECT_NEAR(middle.depth, 0.005, 1e-8);
  EXPECT_EQ(middle.shape, 0);
  EXPECT_EQ(middle.triangle, 0);
  const ToolCrossing cap = crossing(tool, acrossX(0.012));
  EXPECT_EQ(cap.pierced, 0);
  EXPECT_NEAR(cap.depth, 0.003, 1e-8);
  const ToolCrossing outside = crossing(tool, acrossX(0.0151));
  EXPECT_EQ(outside.pierced, 0);
  EXPECT_EQ(outside.depth, 0);
  EXPECT_EQ(outside.shape, -1);
}

TEST(ToolCrossings, DepthIsThatOfTheDeepestPointOfFaceEdgeAndCorner) {
  const ToolModel tool = capsule();
  // a face parallel to the axis, without any of its corners and edges near
  EXPECT_NEAR(crossing(tool, {{-1, -1, 0.004}, {1, -1, 0.004}, {0, 1, 0.004}}).depth, 0.001, 1e-8);
  // an edge across the axis
  EXPECT_NEAR(crossing(tool, {{0.002, -1, 0.003}, {0.002, 1, 0.003}, {0.002, 0, 1}}).depth, 0.002, 1e-8);
  // a corner beside the axis, and one in front of the end
  EXPECT_NEAR(crossing(tool, {{0.002, 0, 0.001}, {0.002, 0.1, 1}, {0.002, -0.1, 1}}).depth, 0.004, 1e-8);
  EXPECT_NEAR(crossing(tool, {{0.013, 0, 0}, {1, 0.1, 0}, {1, -0.1, 0}}).depth, 0.002, 1e-8);
}

TEST(ToolCrossings, ShapesMoveWithTheirLinks) {
  const ToolModel tool = capsule();
  std::vector<Eigen::Isometry3d> poses(static_cast<std::size_t>(tool.linkCount()), Eigen::Isometry3d::Identity());
  poses[0] = Eigen::Translation3d(0.1, 0, 0) * Eigen::AngleAxisd(M_PI / 2, Vector3d::UnitY());
  const Plate plate = acrossX(0.096);
  EXPECT_NEAR(findToolCrossing(tool, poses, plate.view(), {}).depth, 0.005 - 0.004, 1e-8);
}

TEST(ToolCrossings, BoxesCylindersAndSpheresHaveTheirOwnDepth) {
  const ToolModel box = toolOf(shapeOf("<box size=\"0.02 0.01 0.006\"/>", "0 0 0"));
  EXPECT_NEAR(crossing(box, {{0.009, -0.001, -0.001}, {1, -0.001, -0.001}, {1, 0.1, 0}}).depth, 0.001, 1e-8);
  EXPECT_EQ(crossing(box, {{0, 0.001, -1}, {0, 0.001, 1}, {0, -1, 0}}).pierced, 1);
  EXPECT_EQ(crossing(box, {{0.011, -1, -1}, {0.011, 1, -1}, {0.011, 0, 1}}).depth, 0);
  const ToolModel cylinder = toolOf(shapeOf("<cylinder radius=\"0.005\" length=\"0.02\"/>", "0 0 0", kTurn));
  EXPECT_NEAR(crossing(cylinder, {{0.009, 0, 0}, {1, 0.1, 0}, {1, -0.1, 0}}).depth, 0.001, 1e-8);
  EXPECT_EQ(crossing(cylinder, acrossX(0.011)).depth, 0);  // a flat end
  EXPECT_EQ(crossing(cylinder, acrossX(0.009)).pierced, 1);
  const ToolModel sphere = toolOf(shapeOf(kSphere, "0 0 0"));
  EXPECT_NEAR(crossing(sphere, acrossX(0.003)).depth, 0.002, 1e-8);
  EXPECT_EQ(crossing(sphere, acrossX(0.003)).pierced, 0);
}

TEST(ToolCrossings, OpenEndsLetTheToolPass) {
  const ToolModel tool = capsule();
  EXPECT_EQ(crossing(tool, acrossX(0), {0, 0, 0}).pierced, 1);
  EXPECT_EQ(crossing(tool, acrossX(0), {0, 1, 0}).pierced, 0);
  EXPECT_EQ(crossing(tool, acrossX(0), {0, 1, 0}).depth, 0);
}

}  // namespace
}  // namespace vibe::tool_crossings_test
