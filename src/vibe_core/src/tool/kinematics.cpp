#include "tool/kinematics.hpp"

#include <algorithm>
#include <cmath>

#include "arithmetic/elementary.hpp"
#include "vibe_core/solver/step_policy.hpp"

namespace vibe {

namespace {

// The bars of the needle arm, in the frame of the link that carries arm and needle, all in the plane across the axis.
struct Bars {
  Eigen::Vector3d axis;       // unit
  Eigen::Vector3d hinge;      // [m]
  Eigen::Vector3d arm, hook;  // with the arm open: from the hinge and from the needle's point to the pin [m]
  Eigen::Vector3d open, way;  // of the needle's point: with the arm open, and per metre of needle_driver

  Eigen::Vector3d toPoint(double driver) const { return flat(open + driver * way - hinge); }
  Eigen::Vector3d flat(const Eigen::Vector3d& v) const { return v - axis.dot(v) * axis; }
  double turn(const Eigen::Vector3d& from, const Eigen::Vector3d& to) const {
    return math::atan2(axis.dot(from.cross(to)), from.dot(to));
  }
};

std::optional<Bars> barsOf(const ToolModel& tool) {
  const ToolJoint *hinge = findJoint(tool, "needle_arm_hinge"), *arm_pin = findJoint(tool, "needle_arm_pin_mount"),
                  *needle = findJoint(tool, "needle_driver"), *turn = findJoint(tool, "needle_hook_turn"),
                  *hook_pin = findJoint(tool, "needle_hook_pin_mount");
  for (const ToolJoint* joint : {hinge, arm_pin, needle, turn, hook_pin})
    if (joint == nullptr) return std::nullopt;
  if (hinge->parent_link != needle->parent_link) return std::nullopt;
  Bars bars;
  bars.axis = hinge->origin.linear() * hinge->axis;
  bars.hinge = hinge->origin.translation();
  bars.arm = bars.flat(hinge->origin.linear() * arm_pin->origin.translation());
  bars.hook = bars.flat(needle->origin.linear() * turn->origin.linear() * hook_pin->origin.translation());
  bars.open = needle->origin.translation();
  bars.way = needle->origin.linear() * needle->axis;
  return bars;
}

}  // namespace

const ToolJoint* findJoint(const ToolModel& tool, const std::string& name) {
  const auto& joints = tool.joints();
  const auto found = std::find_if(joints.begin(), joints.end(), [&](const ToolJoint& j) { return j.name == name; });
  return found == joints.end() ? nullptr : &*found;
}

std::optional<LinkageTurns> needleLinkage(const ToolModel& tool, double driver) {
  const std::optional<Bars> bars = barsOf(tool);
  if (!bars) return std::nullopt;
  const Eigen::Vector3d to_point = bars->toPoint(driver);
  const double distance = to_point.norm();
  if (!(distance > 0)) return std::nullopt;
  const double arm2 = bars->arm.squaredNorm(), hook2 = bars->hook.squaredNorm();
  const double arm_length = std::sqrt(arm2);
  const double along = std::clamp((arm2 + distance * distance - hook2) / (2 * distance), -arm_length, arm_length);
  const double side = bars->axis.dot(bars->toPoint(0).cross(bars->arm)) < 0 ? -1 : 1;
  const double beside = side * std::sqrt(std::max(0.0, arm2 - along * along));
  const Eigen::Vector3d ahead = to_point / distance;
  const Eigen::Vector3d arm = along * ahead + beside * bars->axis.cross(ahead);
  return LinkageTurns{bars->turn(bars->arm, arm), bars->turn(bars->hook, arm - to_point)};
}

namespace {

constexpr double kPlaced = 1e-26;        // (0.1 pm)^2: rounding, nothing is left to gain
constexpr double kLeastDamping = 1e-12;  // rounding of the normal matrix

// shortest rotation that turns one unit vector into another, as a vector [rad]
Eigen::Vector3d rotationBetween(const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
  const Eigen::Vector3d axis = from.cross(to);
  const double sine = axis.norm();
  const double angle = math::atan2(sine, from.dot(to));
  if (sine > 1e-12) return axis * (angle / sine);
  return angle > 1 ? Eigen::Vector3d(from.unitOrthogonal() * angle) : Eigen::Vector3d::Zero();
}

}  // namespace

InverseKinematics::InverseKinematics(const ToolModel& tool) : tool_(tool), chain_(tool) {}

InverseKinematics::Residual InverseKinematics::residual(const Inputs& inputs) {
  const Eigen::Isometry3d& tip = chain_.place(inputs);
  Residual r;
  r.head<3>() = target_position_ - tip.translation();
  r.tail<3>() = stepPolicy().ik_direction_weight * rotationBetween(tip.linear().col(0), target_direction_);
  return r;
}

// derivative of the tip position and the (weighted) direction with respect to each input, where the chain is; rotation
// about the direction itself does not change it and is projected out
InverseKinematics::Jacobian InverseKinematics::jacobian() const {
  Jacobian j = Jacobian::Zero();
  const Eigen::Vector3d position = chain_.tip().translation();
  const Eigen::Vector3d direction = chain_.tip().linear().col(0);
  for (int link = chain_.count() - 1; link >= 0; --link) {
    const ToolJoint& joint = chain_.joint(link);
    if (joint.type == ToolJoint::Type::Fixed || joint.station >= 0 || joint.input >= kFree) continue;
    const Eigen::Isometry3d& child = chain_.pose(link);
    const Eigen::Vector3d axis =
        joint.multiplier * (child.linear() * joint.axis);  // the motion of a joint does not change its axis
    if (joint.type == ToolJoint::Type::Prismatic) {
      j.col(joint.input).head<3>() += axis;
      continue;
    }
    j.col(joint.input).head<3>() += axis.cross(position - child.translation());
    j.col(joint.input).tail<3>() += stepPolicy().ik_direction_weight * (axis - direction * direction.dot(axis));
  }
  return j;
}

InverseKinematics::Inputs InverseKinematics::moved(const Inputs& from, const Step& step) const {
  Inputs result = from;
  for (int i = 0; i < kFree; ++i)
    result[i] = std::clamp(from[i] + step[i], tool_.limits()[i].lower, tool_.limits()[i].upper);
  return result;
}

// an input at a limit that would leave its range is excluded from this step
void InverseKinematics::holdAtLimits(const Inputs& inputs, const Step& gradient,
                                     Eigen::Matrix<double, kFree, kFree>& matrix, Step& right) const {
  for (int i = 0; i < kFree; ++i) {
    const JointLimits& limit = tool_.limits()[i];
    const bool held = (inputs[i] <= limit.lower && gradient[i] < 0) || (inputs[i] >= limit.upper && gradient[i] > 0);
    if (!held) continue;
    matrix.row(i).setZero();
    matrix.col(i).setZero();
    matrix(i, i) = 1;
    right[i] = 0;
  }
}

// A step from where the chain is.
// @returns false where none leads on
bool InverseKinematics::improve(Descent& at) {
  const StepPolicy& policy = stepPolicy();
  const Jacobian j = jacobian();
  const Eigen::Matrix<double, kFree, kFree> normal = j.transpose() * j;
  const Step gradient = j.transpose() * at.residual;
  // Levenberg and Marquardt: the damping grows until a step makes the error smaller.
  for (; at.damping < policy.ik_most_damping; at.damping *= policy.ik_damping_growth) {
    Eigen::Matrix<double, kFree, kFree> matrix = normal;
    // the constant keeps inputs without effect still, such as the rotation of a straight scope
    matrix.diagonal() += at.damping * (normal.diagonal() + Step::Constant(policy.ik_idle_damping));
    Step right = gradient;
    holdAtLimits(at.inputs, gradient, matrix, right);
    const Step step = matrix.ldlt().solve(right);
    const Inputs trial = moved(at.inputs, step);
    if (!(right.dot(step) > policy.ik_worth_a_step * at.cost) || trial == at.inputs) return false;
    const Residual there = residual(trial);
    if (!(there.squaredNorm() < at.cost)) continue;
    at = {trial, there, there.squaredNorm(), std::max(at.damping / policy.ik_damping_fall, kLeastDamping)};
    return true;
  }
  return false;
}

InverseKinematics::Inputs InverseKinematics::descend(const Inputs& start, double& cost) {
  const Inputs inputs = moved(start, Step::Zero());
  const Residual r = residual(inputs);
  Descent at{inputs, r, r.squaredNorm(), stepPolicy().ik_first_damping};
  for (int iteration = 0; iteration < stepPolicy().ik_max_iterations && at.cost > kPlaced && improve(at);) ++iteration;
  cost = at.cost;
  return at.inputs;
}

InverseKinematics::Inputs InverseKinematics::follow(const Eigen::Isometry3d& target, const Inputs& start) {
  aim(target);
  double cost = 0;
  return descend(start, cost);
}

void InverseKinematics::aim(const Eigen::Isometry3d& target) {
  target_position_ = target.translation();
  target_direction_ = target.linear().col(0);
}

InverseKinematics::Inputs InverseKinematics::solve(const Eigen::Isometry3d& target, const Inputs& start) {
  aim(target);
  double best_cost = 0;
  Inputs best = descend(start, best_cost);
  const StepPolicy& policy = stepPolicy();
  constexpr double kQuarter = 1.5707963267948966;
  // A bent tip has several solutions, as an elbow: other turns and bends begin beside the others.
  for (const double turn : {0.0, kQuarter, -kQuarter, 2 * kQuarter}) {
    for (const double bend : {policy.ik_small_bend, policy.ik_large_bend}) {
      if (best_cost <= policy.ik_good_cost) return best;
      Inputs trial = start;
      trial[Rotation] = std::remainder(start[Rotation] + turn, 4 * kQuarter);
      trial[TipUpDown] = bend * tool_.limits()[TipUpDown].upper;
      trial[TipLeftRight] = 0;
      double cost = 0;
      trial = descend(trial, cost);
      if (cost >= best_cost / policy.ik_better_cost) continue;
      best = trial;
      best_cost = cost;
    }
  }
  return best;
}

}  // namespace vibe
