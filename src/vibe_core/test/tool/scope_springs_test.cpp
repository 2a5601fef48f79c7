// The springs between hand and tip against beam theory.
#include "vibe_core/tool/scope_springs.hpp"

#include <gtest/gtest.h>

#include "tool/tool_motion.hpp"
#include "vibe_testing/scope_fixture.hpp"

namespace vibe::scope_springs_test {
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
      const ToolYield yield = springs.during(joints, q, q, kStep).yield();
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
  const ToolYield yield = springs.during(scope.joints, q, q, kStep).yield();
  const double left = std::exp(-kStep / scope.scene.relaxation_time);
  for (int d = 1; d < kYieldDofs; ++d) EXPECT_NEAR(q[d] + yield.free[d], left * q[d], 0.005 * std::abs(q[d]) + 1e-12);
  ToolDisplacement far = q;
  far[kShaftDof] = 5;  // 7 cm at the tip
  const double way = -springs.during(scope.joints, far, far, kStep).yield().free[kShaftDof] / 5 * 0.07;
  EXPECT_LT(way, 0.35 * kStep) << "springs back no faster than a brisk hand";
}

// A constant force from rest: q = F/K (1 - exp(-t/tau)).
TEST(ScopeSprings, StepsAreOfSecondOrder) {
  const Loaded scope(0.1);
  const ScopeSprings springs(scope.tool, scope.scene);
  const auto errorOf = [&](int steps) {
    ToolDisplacement q{};
    for (int i = 0; i < steps; ++i) {
      const ToolYield yield = springs.during(scope.joints, q, q, 0.1 / steps).yield();
      q[TipUpDown] += yield.free[TipUpDown] + yield.compliance(TipUpDown, TipUpDown) * 1e-3;
    }
    return q[TipUpDown] - 1e-3 / scope.scene.bending_stiffness * (1 - std::exp(-0.1 / scope.scene.relaxation_time));
  };
  EXPECT_NEAR(errorOf(6) / errorOf(12), 4, 0.1);
}

// What the force does = energy of the spring + losses, for any relaxation time.
TEST(ScopeSprings, LossClosesTheEnergyOfAStep) {
  Loaded scope(0.1);
  for (const double time : {0.0, 0.001, 0.01, 0.05}) {
    scope.scene.relaxation_time = time;
    const ScopeSprings springs(scope.tool, scope.scene);
    ToolDisplacement from{}, to{};
    from[TipLeftRight] = 0.02, to[TipLeftRight] = 0.013;
    const ScopeSpringStep during = springs.during(scope.joints, from, from, kStep);
    const double work = -during.load(to)[TipLeftRight] * (to[TipLeftRight] - from[TipLeftRight]);
    const double stored = springs.energy(scope.joints, to) - springs.energy(scope.joints, from);
    EXPECT_NEAR(work, stored + during.loss(to), 1e-12) << time;
    EXPECT_GE(during.loss(to), 0) << time;
  }
}

TEST(ScopeSprings, ThoseThatRelaxFastDoNotOvershoot) {
  Loaded scope(0.1);
  for (const double time : {0.0, 0.001, 0.005, 0.01, 0.1}) {
    scope.scene.relaxation_time = time;
    const ScopeSprings springs(scope.tool, scope.scene);
    ToolDisplacement q{};
    q[TipUpDown] = 0.1;
    const double left = q[TipUpDown] + springs.during(scope.joints, q, q, kStep).yield().free[TipUpDown];
    EXPECT_GE(left, -1e-15) << time;
    EXPECT_LT(left, q[TipUpDown]) << time;
  }
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
    const ScopeSpringStep during = springs.during(joints, q, q, kStep);
    q[Insertion] -= end[Insertion] - joints[Insertion];  // the tip is held
    joints = end;
    most = std::max(most, during.load(q)[Insertion]);
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
}  // namespace vibe::scope_springs_test
