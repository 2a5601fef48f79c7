// What a haptic device is told about the tissue: against springs, finite differences and the tissue itself.
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>

#include "haptics/impedance_estimator.hpp"
#include "solver/implicit_worlds.hpp"

namespace vibe::tool_impedance_test {
namespace {

using namespace test;

constexpr double kFrame = 1.0 / 60;
constexpr double kSpring = 100;  // [N/m]
const std::vector<float> kNoGas;

// Nodes that hardly feel each other, each on a spring of its own.
ElasticBody springs() {
  ElasticBody body = block({1, 1, 1}, {Law::NeoHookean, 1e-3, kNu, 0});
  body.foundation.assign(body.rest.size(), kSpring);
  return body;
}

ToolRow rowOf(int node, const Eigen::Vector3d& direction) {
  ToolRow row;
  row.surface = SurfacePoint::ofNode(node);
  row.direction = direction;
  row.motion.setZero();
  row.motion.head<3>() = direction.transpose();
  return row;
}

ToolContactRows held(int node) {
  ToolContactRows touch;
  for (int k = 0; k < 3; ++k) touch.rows.push_back(rowOf(node, Eigen::Vector3d::Unit(k)));
  touch.place.setZero(), touch.speed.setZero(), touch.force.setZero();
  return touch;
}

class Estimate {
 public:
  explicit Estimate(ElasticBody of) : body(std::move(of)), motion(body), estimator(body, kFrame, RestStiffness(body)) {}

  std::optional<ToolImpedance> next(const ToolContactRows& touch) {
    return estimator.update(step++, touch, {motion.x[0].data(), motion.x[1].data(), motion.x[2].data()}, kNoGas, 0,
                            memory);
  }

  ElasticBody body;
  BodyMotion motion;
  ImpedanceEstimator estimator;
  ImpedanceMemory memory;
  std::int64_t step = 0;
};

TEST(ToolImpedance, OfAParticleOnASpringIsTheSpring) {
  Estimate estimate(springs());
  ToolContactRows touch = held(3);
  const Eigen::Vector3d at(0.3, 0.2, 0.1), pulled(2e-3, -1e-3, 5e-4);
  touch.place.head<3>() = at + pulled;
  touch.force.head<3>() = -kSpring * pulled;
  const auto response = estimate.next(touch);
  ASSERT_TRUE(response);
  EXPECT_LT((response->stiffness - kSpring * Eigen::Matrix3d::Identity()).norm(), 1e-3 * kSpring);
  EXPECT_LT((response->equilibrium - at).norm(), 1e-5);
  EXPECT_EQ(response->force, touch.force.head<3>());
  EXPECT_EQ(response->damping.norm(), 0);
}

TEST(ToolImpedance, DampingIsThatOfTheWallAndOfTheMassThatMovesAlong) {
  ElasticBody body = springs();
  body.mass_damping = 30;
  body.stiffness_damping = 1e-3;
  Estimate estimate(body);
  ToolContactRows touch = held(3);
  touch.speed.head<3>() = Eigen::Vector3d(0.01, 0, 0);
  const double damping = 1e-3 * kSpring + 30 * body.mass[3];
  touch.force.head<3>() = Eigen::Vector3d(-damping * 0.01, 0, 0);
  std::optional<ToolImpedance> response;
  for (int i = 0; i < 20; ++i) response = estimate.next(touch);  // the mass is found in the background
  ASSERT_TRUE(response);
  EXPECT_LT((response->damping - damping * Eigen::Matrix3d::Identity()).norm(), 2e-3 * damping);
  EXPECT_LT(response->equilibrium.norm(), 1e-7);  // moving through it, and not away from it
}

TEST(ToolImpedance, ASlidingContactPushesAlongItsNormalOnly) {
  Estimate estimate(springs());
  ToolContactRows touch = held(3);
  const Eigen::Vector3d normal = Eigen::Vector3d(1, 2, 2) / 3, at(0.01, 0.02, 0.03);
  touch.rows.assign(1, rowOf(3, normal));
  touch.place.head<3>() = at;
  touch.force.head<3>() = -0.2 * normal + 0.02 * normal.unitOrthogonal();
  const auto response = estimate.next(touch);
  ASSERT_TRUE(response);
  EXPECT_LT((response->stiffness - kSpring * normal * normal.transpose()).norm(), 1e-3 * kSpring);
  EXPECT_LT((response->equilibrium - (at - 0.2 / kSpring * normal)).norm(), 1e-5);
}

TEST(ToolImpedance, AJointFeelsItThroughItsLever) {
  Estimate estimate(springs());
  ToolContactRows touch = held(3);
  touch.rows[1].motion[3 + Rotation] = 0.1;  // y moves by 0.1 m/rad
  touch.place[3 + Rotation] = 0.5;
  touch.force[3 + Rotation] = -0.02;
  const auto response = estimate.next(touch);
  ASSERT_TRUE(response);
  const JointResponse& joint = response->joints[Rotation];
  EXPECT_NEAR(joint.stiffness, 0.01 * kSpring, 1e-3);
  EXPECT_NEAR(joint.equilibrium, 0.5 - 0.02, 1e-4);
  EXPECT_EQ(response->joints[Insertion].stiffness, 0);
  EXPECT_EQ(response->joints[Insertion].equilibrium, response->joints[Insertion].position);
}

TEST(ToolImpedance, OfABeamIsTheSlopeOfItsEquilibria) {
  const ElasticBody body = cantilever();
  Estimate estimate(body);
  const int tip = body.nodeCount() - 1, other = tip - 4;
  ToolContactRows touch = held(tip);
  for (const ToolRow& row : held(other).rows) touch.rows.push_back(row);
  const auto response = estimate.next(touch);
  ASSERT_TRUE(response);
  Eigen::Matrix3d slope;
  constexpr double kMove = 2e-5;
  for (int k = 0; k < 3; ++k) {
    Eigen::Vector3d force[2];
    for (int side = 0; side < 2; ++side) {
      Body run(body);
      for (int node : {tip, other})
        for (int c = 0; c < 3; ++c) {
          LinearConstraint constraint;
          constraint.node.assign(1, node);
          constraint.coefficient.assign(1, Eigen::Vector3d::Unit(c));
          constraint.target = body.rest[node][c] + (c == k ? (side == 0 ? kMove : -kMove) : 0);
          run.loads.constraints.push_back(constraint);
        }
      ASSERT_TRUE(run.settle(1e-9).converged);
      for (int c = 0; c < 3; ++c) force[side][c] = run.loads.constraints[c].force + run.loads.constraints[3 + c].force;
    }
    slope.col(k) = (force[0] - force[1]) / (2 * kMove);
  }
  EXPECT_LT((response->stiffness - slope).norm(), 0.02 * slope.norm());
  EXPECT_EQ(response->stiffness, response->stiffness.transpose());
  EXPECT_GT(Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(response->stiffness).eigenvalues()[0], 0);
}

TEST(ToolImpedance, NothingTouchedIsNoResponse) {
  Estimate estimate(springs());
  ToolContactRows touch = held(3);
  touch.rows.clear();
  EXPECT_FALSE(estimate.next(touch));
  EXPECT_TRUE(estimate.next(held(3)));
}

TEST(ToolImpedance, FollowsTheSlopeOfTheForcesAlongTheMotion) {
  Estimate estimate(springs());
  ToolContactRows touch = held(3);
  const Eigen::Vector3d along = Eigen::Vector3d(2, 1, 2) / 3;
  std::optional<ToolImpedance> response;
  for (int i = 0; i < 5; ++i) {  // the tissue has softened to 60 N/m along the way
    touch.place.head<3>() = 1e-3 * i * along;
    touch.force.head<3>() = -60e-3 * i * along;
    response = estimate.next(touch);
  }
  const Eigen::Vector3d across = along.unitOrthogonal();
  EXPECT_NEAR(along.dot(response->stiffness * along), 60, 0.1);
  EXPECT_NEAR(across.dot(response->stiffness * across), kSpring, 0.1);
  EXPECT_LT(response->equilibrium.norm(), 1e-5);
  response = estimate.next(touch);  // at rest it stays
  EXPECT_NEAR(along.dot(response->stiffness * along), 60, 0.1);
  for (ToolRow& row : touch.rows) row.surface.node[0] = 5;  // something else is touched: no slope
  touch.place.head<3>() += 1e-3 * across;
  response = estimate.next(touch);
  EXPECT_NEAR(across.dot(response->stiffness * across), kSpring, 0.1);
}

TEST(SlopeCorrection, StaysSymmetricAndPositiveSemidefiniteWhateverIsSeen) {
  for (int seed = 0; seed < 200; ++seed) {
    std::srand(static_cast<unsigned>(seed));
    const Eigen::Matrix3d root = Eigen::Matrix3d::Random();
    const Eigen::Matrix3d stiffness = 100 * root * root.transpose();
    SlopeMemory<3> memory;
    SlopeCorrection<3> slope(memory);
    slope.observe(stiffness, Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero(), false);
    slope.observe(stiffness, 1e-3 * Eigen::Vector3d::Random(), 0.1 * Eigen::Vector3d::Random(), true);
    const Eigen::Matrix3d corrected = slope.corrected(stiffness);
    EXPECT_LT((corrected - corrected.transpose()).norm(), 1e-12 * stiffness.norm());
    EXPECT_GT(Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(corrected).eigenvalues()[0], -1e-12 * stiffness.norm());
    EXPECT_LT(corrected.norm(), 10 * stiffness.norm());
  }
}

}  // namespace
}  // namespace vibe::tool_impedance_test
