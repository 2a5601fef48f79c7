// Where a needle arm that is a body passes through a sheet of tissue, and where it does not.
#include "tool_contact/needle_passage.hpp"

#include <gtest/gtest.h>

#include "tool_contact/sheet_scene.hpp"
#include "vibe_core/arithmetic/rotation.hpp"

namespace vibe::needle_passage_test {
namespace {

using namespace test::sheet;

// In the frame of the tip: the way of the needle's point, and across the plane in which arm and hook turn.
const Eigen::Vector3d kWay(-0.6, 0, -0.8), kBeside(0, 1, 0);
// A sheet that is wider than the arm, and one that is narrow, as the top of a fold between needle and cap [m].
constexpr double kSheet = 0.03, kFold = 0.003;

struct ArmBeforeSheet {
  ArmBeforeSheet(double size, int cells)
      : tool(ToolModel::fromUrdf(scopeText(), "scope.urdf", NeedleArm::Body)),
        mesh(sheet(size, cells)),
        start(pointsOf(mesh)),
        none(mesh.vertices.size(), 0),
        contacts(tool, mesh, std::vector<double>(mesh.vertices.size(), kThickness), none) {}

  /// Contacts of arm and hook where the needle's point is `gap` before the sheet. @param ahead  what points at the
  /// sheet
  int count(double closed, bool leads, const Eigen::Vector3d& ahead, double gap) {
    std::vector<Eigen::Isometry3d> poses;
    tool.forwardKinematics({0, 0, 0, 0, 0, 0, closed * tool.limits()[NeedleDriver].upper}, poses);
    Eigen::Isometry3d base = Eigen::Isometry3d::Identity();
    base.linear() = rotationBetween(ahead, Eigen::Vector3d::UnitX()).toRotationMatrix();
    base.translation() = -gap * Eigen::Vector3d::UnitX() -
                         base.linear() * poses[static_cast<std::size_t>(tool.linkIndex("needle"))].translation();
    for (Eigen::Isometry3d& pose : poses) pose = base * pose;
    int count = 0;
    for (const SurfaceContact& contact : contacts.find(poses, poses, pathOf(start, start), 2e-3, none, 1, leads)) {
      const std::string& link = tool.linkName(tool.shapes()[static_cast<std::size_t>(contact.shape)].link);
      count += link == "needle_arm" || link == "needle_hook" ? 1 : 0;
    }
    return count;
  }

  ToolModel tool;
  SurfaceMesh mesh;
  Points start;
  std::vector<char> none;
  SurfaceContacts contacts;
};

TEST(NeedlePassage, IsAheadOfANeedleThatIsOnTheArm) {
  ArmBeforeSheet arm(kFold, 2);
  EXPECT_EQ(arm.count(0.5, true, kWay, 1.2e-3), 0);
  EXPECT_GT(arm.count(0.5, false, kWay, 1.2e-3), 0) << "control: an arm without its needle is blunt";
  EXPECT_GT(arm.count(0.2, true, kWay, 1.2e-3), 0) << "control: the needle has not passed the cap";
}

TEST(NeedlePassage, IsNotBesideTheWayOfTheNeedle) {
  ArmBeforeSheet arm(kSheet, 6);
  EXPECT_GT(arm.count(0.5, true, kBeside, 1.4e-3), 0);
  EXPECT_EQ(arm.count(0.5, true, kBeside, 0.9e-3), 0) << "control: a bite is found there";
}

TEST(NeedlePassage, IsWhereTheWallIsPiercedAlready) {
  ArmBeforeSheet arm(kSheet, 2);  // all triangles share a vertex with those that the hook crosses
  EXPECT_EQ(arm.count(0.2, false, kWay, -2e-3), 0);
  EXPECT_GT(arm.count(0.2, false, kBeside, 1.4e-3), 0) << "control: the hook is before the sheet";
}

TEST(NeedlePassage, AnArmThatIsClosedTouchesNothing) {
  ArmBeforeSheet arm(kSheet, 6);
  EXPECT_EQ(arm.count(0.96, false, kBeside, 1.4e-3), 0);
  EXPECT_GT(arm.count(0.90, false, kBeside, 1.4e-3), 0) << "control: it has begun to open";
}

}  // namespace
}  // namespace vibe::needle_passage_test
