// The springs between hand and tip against beam theory.
#include "vibe_core/contact/scope_springs.hpp"

#include <gtest/gtest.h>

#include "contact/scope_fixture.hpp"
#include "contact/tool_jacobian.hpp"

namespace vibe {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

constexpr double kStep = 1.0 / 60;

/// The scope under a constant force on the end of its shaft (or another link), in equilibrium.
struct Loaded {
  ToolModel tool = loadScope();
  ScopeComplianceScene scene;
  std::array<double, kJointCount> joints{};
  ToolDisplacement q{};
  std::vector<Isometry3d> poses;
  int link;

  explicit Loaded(double free_length, const char* where = "scope_neck") : link(tool.linkIndex(where)) {
    joints[Insertion] = free_length - tool.freeLength(0);
    tool.forwardKinematics(joints, poses);
  }
  YieldVector pull(const Vector3d& force) const {
    return yieldJacobian(tool, poses, tool.shaftBend(joints, q), link, poses[link].translation()).transpose() * force;
  }
  void settle(const Vector3d& force, int steps = 400) {
    const ScopeSprings springs(tool, scene);
    for (int i = 0; i < steps; ++i) {
      const ToolYield yield = springs.yield(joints, q, kStep);
      const YieldVector moved = yield.free + yield.compliance * pull(force);
      for (int d = 0; d < kYieldDofs; ++d) q[d] += moved[d];
      tool.forwardKinematics(joints, q, poses);
    }
  }
  Vector3d shift() {
    std::vector<Isometry3d> straight;
    tool.forwardKinematics(joints, straight);
    return poses[link].translation() - straight[link].translation();
  }
};

// F L^3 / 3 EI and F L^2 / 2 EI (Gere and Timoshenko), at any free length and in any direction
TEST(ScopeSprings, ShaftBendsLikeACantilever) {
  for (double length : {0.01, 0.05, 0.1, 0.2})
    for (const Vector3d& direction : {Vector3d(0, 1, 0), Vector3d(0, 0, -1), Vector3d(0, 0.6, 0.8)}) {
      Loaded scope(length);
      scope.scene.axial_stiffness = 1e7;  // or the force that pushes a bent beam out of its clamp shortens it
      const double rigidity = scope.scene.shaft_rigidity, force = 0.01 * 3 * rigidity / (length * length);
      scope.settle(force * direction);
      EXPECT_NEAR(scope.shift().dot(direction), 0.01 * length, 1e-3 * 0.01 * length) << length;
      const Vector3d axis = scope.poses[scope.link].linear().col(0);
      EXPECT_NEAR(axis.dot(direction), 0.015, 1e-3 * 0.015) << length;
    }
}

// Large deflections: elastica under a dead load F L^2 / EI = 1 (Bisshopp and Drucker 1945): 0.302 L across, 0.056 L
// back.
TEST(ScopeSprings, LargeDeflectionIsNearTheElastica) {
  Loaded scope(0.2);
  scope.settle({0, 0, scope.scene.shaft_rigidity / 0.04}, 2000);
  EXPECT_NEAR(scope.shift().z(), 0.302 * 0.2, 0.01 * 0.2);
  EXPECT_NEAR(-scope.shift().x(), 0.056 * 0.2, 0.01 * 0.2);
}

TEST(ScopeSprings, StraightScopeIsShortenedByTheForceAlongIt) {
  Loaded scope(0.1, "scope_tip");
  scope.settle({-10, 0, 0});
  EXPECT_NEAR(scope.shift().x(), -10 / scope.scene.axial_stiffness, 1e-9);
  EXPECT_NEAR(scope.shift().tail<2>().norm(), 0, 1e-9);
}

TEST(ScopeSprings, TwistsByTorqueTimesLengthOverRigidity) {
  const Loaded scope(0.1);
  const ScopeSprings springs(scope.tool, scope.scene);
  const double twisted = scope.scene.outer_length + scope.joints[Insertion];
  EXPECT_NEAR(springs.stiffness(scope.joints[Insertion])[Rotation], scope.scene.torsional_rigidity / twisted, 1e-12);
}

TEST(ScopeSprings, RelaxesByItsTimeConstant) {
  const Loaded scope(0.1);
  const ScopeSprings springs(scope.tool, scope.scene);
  const ToolDisplacement q = {1e-4, 1e-3, 1e-3, 0, 1e-3, 0, 0, 1e-3};
  const ToolYield yield = springs.yield(scope.joints, q, kStep);
  const double left = scope.scene.relaxation_time / (kStep + scope.scene.relaxation_time);
  for (int d = 1; d < kYieldDofs; ++d) EXPECT_NEAR(q[d] + yield.free[d], left * q[d], 1e-12);
  ToolDisplacement far = q;
  far[kShaftDof] = 5;  // 7 cm at the tip
  const double way = -springs.yield(scope.joints, far, kStep).free[kShaftDof] / 5 * 0.07;
  EXPECT_LT(way, 0.35 * kStep) << "springs back no faster than a brisk hand";
}

TEST(ScopeSprings, ConfigurationalForceIsTheSlopeOfTheEnergy) {
  const Loaded scope(0.1);
  const ScopeSprings springs(scope.tool, scope.scene);
  const ToolDisplacement q = {0, 0.2, 0.1, 0, 3, -2, 1, 4};
  auto more = scope.joints, less = scope.joints;
  more[Insertion] += 1e-6;
  less[Insertion] -= 1e-6;
  const double slope = (springs.energy(more, q) - springs.energy(less, q)) / 2e-6;
  EXPECT_NEAR(springs.configurationalForce(scope.joints, q), -slope, 1e-6);
  // M^2 / 2 EI of a beam bent to one curvature
  EXPECT_NEAR(springs.configurationalForce(scope.joints, {0, 0, 0, 0, 3}), -0.5 * scope.scene.shaft_rigidity * 9, 1e-9);
}

// Whatever holds the tool, the springs never carry more than the hand has.
TEST(ScopeSprings, HandStallsAtItsLimit) {
  const Loaded scope(0.05);
  const ScopeSprings springs(scope.tool, scope.scene);
  std::array<double, kJointCount> joints = scope.joints;
  ToolDisplacement q{};
  const double limit = scope.tool.limits()[Insertion].effort;
  double most = 0;
  for (int i = 0; i < 200; ++i) {
    auto command = joints;
    command[Insertion] += 0.15 * kStep;
    const auto end = springs.handMotion(joints, command, q, kStep);
    const double moved = end[Insertion] - joints[Insertion], stiffness = scope.scene.axial_stiffness;
    const double damping = springs.relaxationTime(joints, q) / kStep;
    q[Insertion] -= moved;  // the tip is held
    joints = end;
    most = std::max(most, -stiffness * (q[Insertion] - damping * moved));
  }
  EXPECT_LE(most, limit * (1 + 1e-9));
  EXPECT_NEAR(-scope.scene.axial_stiffness * q[Insertion], limit, 0.01 * limit);
  q[Insertion] = -2 * limit / scope.scene.axial_stiffness;
  EXPECT_LT(springs.handMotion(joints, joints, q, kStep)[Insertion], joints[Insertion]) << "pushed back";
}

TEST(ScopeSprings, UrdfWithoutJointsOfTheShaftHasAStraightOne) {
  std::string text = scopeText();
  for (const char* name : {"shaft_up_down_", "shaft_left_right_"})
    for (int k = 1; k <= 7; ++k) {
      const std::string joint = std::string("<joint name=\"") + name + std::to_string(k) + "\" type=\"revolute\"";
      text.replace(text.find(joint), joint.size(),
                   std::string("<joint name=\"") + name + std::to_string(k) + "\" type=\"fixed\"");
    }
  const ToolModel tool = ToolModel::fromUrdf(text, "scope.urdf");
  const YieldVector k = ScopeSprings(tool, {}).stiffness(0.2);
  EXPECT_GT(k[Insertion], 0);
  EXPECT_EQ(k.tail<4>().norm(), 0);
}

}  // namespace
}  // namespace vibe
