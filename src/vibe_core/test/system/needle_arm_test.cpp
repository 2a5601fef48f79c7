// A needle arm that is a body, in a ball: it opens against the wall, and gives its force to the scope.
#include <gtest/gtest.h>

#include <memory>
#include <regex>
#include <string>

#include "procedure/needle.hpp"
#include "tool/tool_motion.hpp"
#include "vibe_core/model/accounting.hpp"
#include "vibe_core/simulation/simulator.hpp"
#include "vibe_testing/scope_worlds.hpp"

namespace vibe::needle_arm_test {
namespace {

using test::World;

constexpr double kRadius = 0.05, kThickness = 2e-3, kOpenIn = 0.4, kClosed = 0.018;
constexpr double kHookRadius = 0.5e-3, kInto = 2e-3;
const Eigen::Vector3d kBend(3.1e-3, 0, 0.4e-3);  // the foremost place of the hook, in its frame

/// The scope where the open hook's foremost place would be `kInto` deeper than where it begins to touch; closed.
World closedBeforeWall(bool body, double effort = 8) {
  Scene scene = test::shellUnderScope(kRadius);
  scene.scope->needle_arm = body;
  const std::string limit = "upper=\"0.018\" velocity=\"0.1\" effort=\"8\"";
  std::string text = std::regex_replace(scopeText(), std::regex(limit),
                                        "upper=\"0.018\" velocity=\"0.1\" effort=\"" + std::to_string(effort) + "\"");
  World world(scene, test::openBall(kRadius, 4, kThickness), text);
  world.state.joints[Insertion] = 0.0806;
  world.state.joints[NeedleDriver] = kClosed;
  return world;
}

std::vector<Eigen::Isometry3d> posesOf(const World& world) {
  std::vector<Eigen::Isometry3d> poses;
  world.model->tool->forwardKinematics(world.state.joints, poses);
  for (Eigen::Isometry3d& pose : poses) pose = world.model->tool_base * pose;
  return poses;
}

/// The arm moves to `driver`.
void swing(World& world, double driver, double seconds = kOpenIn) {
  StepInput input = test::scopeAt(world.state.joints[Insertion]);
  input.joints[NeedleDriver] = driver;
  world.run(seconds, input);
}

/// How far the foremost place of the hook is outside of the wall's middle [m].
double outside(const World& world) {
  const Eigen::Vector3d p =
      posesOf(world)[static_cast<std::size_t>(world.model->tool->linkIndex("needle_hook"))] * kBend;
  const SurfaceView wall{world.model->organ.surface.triangles, world.state.x, world.state.y, world.state.z};
  return deepestPoint(wall, p, p).distance;
}

struct ArmLoad {
  double force = 0;   // on arm and hook [N]
  double effort = 0;  // of their drive, positive if it opens them against the wall [N]
};

ArmLoad loadOf(const World& world) {
  const std::vector<Eigen::Isometry3d> poses = posesOf(world);
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  ArmLoad load;
  for (const ToolContact& touch : world.workspace->report().contacts) {
    const std::string& link = world.model->tool->linkName(touch.link);
    EXPECT_TRUE(link == "needle_arm" || link == "needle_hook") << link;
    sum += touch.force;
    load.effort += pointJacobian(*world.model->tool, poses, touch.link, touch.point).col(NeedleDriver).dot(touch.force);
  }
  load.force = sum.norm();
  return load;
}

TEST(NeedleArm, OpensTheWallByWhatItsHookReachesInto) {
  World world = closedBeforeWall(true);
  swing(world, 0);
  EXPECT_NEAR(world.state.joints[NeedleDriver], 0, 1e-9);
  EXPECT_NEAR(outside(world), -(kHookRadius + kThickness / 2), 0.35e-3);
  EXPECT_GT(world.maxShift(), 0.7 * kInto);
  EXPECT_GT(loadOf(world).force, 0.05);
  EXPECT_NEAR(world.state.tool_force.norm(), loadOf(world).force, 1e-9);
  // control: a drawn arm passes through the wall
  World drawn = closedBeforeWall(false);
  swing(drawn, 0);
  EXPECT_EQ(drawn.state.contact_count, 0);
  EXPECT_EQ(drawn.maxShift(), 0);
}

TEST(NeedleArm, TheWorkOfItsDriveIsInTheWall) {
  World world = closedBeforeWall(true);
  const double before = energyBalance(*world.model, world.state);
  swing(world, 0);
  const double opened = world.state.energy.hand_work;
  EXPECT_GT(opened, 1e-5);
  EXPECT_NEAR(world.state.energy.tool_work, opened, 0.02 * opened) << "the turns of arm and hook with their drive";
  swing(world, kClosed);
  EXPECT_LT(world.state.energy.hand_work, opened) << "the wall gives a part back";
  EXPECT_GT(world.state.energy.hand_work, 0) << "and not more than it got";
  EXPECT_NEAR(energyBalance(*world.model, world.state), before, 0.02 * opened);
  RecordProperty("opened_uJ", std::to_string(1e6 * opened));
}

TEST(NeedleArm, StopsWhereItsDriveIsTooWeak) {
  constexpr double kEffort = 0.05;
  World weak = closedBeforeWall(true, kEffort), strong = closedBeforeWall(true);
  swing(weak, 0);
  swing(strong, 0);
  EXPECT_GT(loadOf(strong).effort, kEffort);
  EXPECT_LT(loadOf(weak).effort, 1.05 * kEffort);
  EXPECT_GT(weak.state.joints[NeedleDriver], 0.2e-3);
  swing(weak, kClosed);  // and it gets away
  EXPECT_NEAR(weak.state.joints[NeedleDriver], kClosed, 1e-9);
}

TEST(NeedleArm, GoesOnFromASnapshotWhileItOpensTheWall) {
  World world = closedBeforeWall(true);
  swing(world, 0, 0.18);
  const State snapshot = world.state;
  ASSERT_GT(world.state.contact_count, 0);
  swing(world, 0, 0.2);
  const std::uint64_t there = hash(world.state);
  World again = closedBeforeWall(true);
  again.state = snapshot;
  swing(again, 0, 0.2);
  EXPECT_EQ(hash(again.state), there);
}

}  // namespace
}  // namespace vibe::needle_arm_test
