#include "trainee/ik_solution.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "arithmetic/elementary.hpp"
#include "tool/kinematics.hpp"
#include "vibe_core/arithmetic/rotation.hpp"

namespace vibe {

namespace {

// Of iteration, as the tip turns with the joints, and the target point with it: at first aiming the direction too; then
// as often keeping the direction, so that the point is reached.
constexpr int kIkRounds = 5;
constexpr double kMissWeight = 1 / 2e-3;  // a miss of 2 mm costs as much as half a radian of turn
constexpr double kTurnWeight = 2;
constexpr double kMoveWeight = 0.15;  // per radian of joint motion: prefers solutions near the current position

// Of reachFor(): a damped Newton iteration with the smallest motion, in which 0.1 m of insertion count as a radian.
constexpr int kReaching = TipLeftRight + 1;  // joints that move the tip
constexpr double kComparable[kReaching] = {0.1, 1, 1, 1};
constexpr int kReachRounds = 12;
constexpr double kSmall = 1e-5;    // of a difference quotient
constexpr double kDamping = 1e-6;  // (1 mm per radian)^2
constexpr double kMaxStep = 0.3;   // [rad]

/// The scope of a model without loads, in the frame of its base.
struct Scope {
  explicit Scope(const Model& of) : model(of), to_base(of.tool_base.inverse()), kinematics(*of.tool) {}

  Eigen::Vector3d pointAt(const std::array<double, kJointCount>& joints, const Eigen::Vector3d& offset) {
    return model.tool_base * (kinematics.place(joints) * offset);
  }

  const Model& model;
  const Eigen::Isometry3d to_base;
  InverseKinematics kinematics;
};

// A round that moves no joint would be repeated by those that aim as it does.
IkSolution aimFrom(Scope& scope, const Eigen::Vector3d& point, const Eigen::Vector3d& direction,
                   const Eigen::Vector3d& offset, const std::array<double, kJointCount>& start) {
  const Eigen::Vector3d ahead = scope.to_base.linear() * direction;
  IkSolution aim{start};
  for (const bool directed : {true, false})
    for (int round = 0; round < kIkRounds; ++round) {
      Eigen::Isometry3d target = scope.kinematics.place(aim.joints);
      target.translation() = scope.to_base * point - target.linear() * offset;
      if (directed)
        target.linear() = rotationBetween(target.linear().col(0), ahead).toRotationMatrix() * target.linear();
      const std::array<double, kJointCount> before =
          std::exchange(aim.joints, scope.kinematics.follow(target, aim.joints));
      if (aim.joints == before) break;
    }
  const Eigen::Isometry3d tip = scope.model.tool_base * scope.kinematics.place(aim.joints);
  aim.miss = (tip * offset - point).norm();
  aim.turn = math::acos(std::clamp(tip.linear().col(0).dot(direction), -1.0, 1.0));
  return aim;
}

double costOf(const IkSolution& aim, const std::array<double, kJointCount>& start) {
  double moved = 0;
  for (int j = Rotation; j <= TipLeftRight; ++j) moved += std::abs(aim.joints[j] - start[j]);
  return kMissWeight * aim.miss + kTurnWeight * aim.turn + kMoveWeight * moved;
}

}  // namespace

IkSolution aimAt(const Model& model, const Eigen::Vector3d& point, const Eigen::Vector3d& direction,
                 const Eigen::Vector3d& offset, const std::array<double, kJointCount>& start) {
  Scope scope(model);
  IkSolution best;
  double min = std::numeric_limits<double>::infinity();
  for (const double turn : {0.0, 0.7, -0.7, 1.5, -1.5})
    for (const double bend : {0.0, 0.5, 1.2}) {
      std::array<double, kJointCount> from = start;
      from[Rotation] = std::clamp(from[Rotation] + turn, -3.1, 3.1);
      if (bend > 0) from[TipUpDown] = bend;
      const IkSolution aim = aimFrom(scope, point, direction, offset, from);
      const double cost = costOf(aim, start);
      if (cost < min) min = cost, best = aim;
    }
  return best;
}

IkSolution reachFor(const Model& model, const Eigen::Vector3d& point, const Eigen::Vector3d& offset,
                    const std::array<double, kJointCount>& start) {
  Scope scope(model);
  IkSolution aim{start};
  for (int round = 0; round < kReachRounds; ++round) {
    const Eigen::Vector3d now = scope.pointAt(aim.joints, offset);
    Eigen::Matrix<double, 3, kReaching> slope;  // of the point, per unit of comparable motion
    for (int j = 0; j < kReaching; ++j) {
      std::array<double, kJointCount> moved = aim.joints;
      moved[j] += kSmall * kComparable[j];
      slope.col(j) = (scope.pointAt(moved, offset) - now) / kSmall;
    }
    const Eigen::Matrix3d square = slope * slope.transpose() + kDamping * Eigen::Matrix3d::Identity();
    const Eigen::Matrix<double, kReaching, 1> step = slope.transpose() * square.ldlt().solve(point - now);
    for (int j = 0; j < kReaching; ++j) {
      const JointLimits& limit = model.tool->limits()[j];
      aim.joints[j] = std::clamp(aim.joints[j] + kComparable[j] * std::clamp(step[j], -kMaxStep, kMaxStep), limit.lower,
                                 limit.upper);
    }
  }
  aim.miss = (scope.pointAt(aim.joints, offset) - point).norm();
  return aim;
}

std::optional<std::array<double, kJointCount>> rolled(const Model& model, std::array<double, kJointCount> joints,
                                                      double angle) {
  const double bend = math::hypot(joints[TipUpDown], joints[TipLeftRight]);
  const double plane = math::atan2(joints[TipLeftRight], joints[TipUpDown]) + angle;
  joints[Rotation] = std::remainder(joints[Rotation] + angle, 2 * M_PI);
  joints[TipUpDown] = bend * math::cos(plane);
  joints[TipLeftRight] = bend * math::sin(plane);
  for (const Joint joint : {Rotation, TipUpDown, TipLeftRight}) {
    const JointLimits& limit = model.tool->limits()[joint];
    if (joints[joint] < limit.lower || joints[joint] > limit.upper) return {};
  }
  return joints;
}

}  // namespace vibe
