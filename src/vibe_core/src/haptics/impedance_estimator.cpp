#include "haptics/impedance_estimator.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace vibe {

namespace {

constexpr double kInterval = 0.25;       // between renewals of the stiffness [s]
constexpr double kFar = 5e-4;            // a node that has moved farther asks for a renewal [m]
constexpr double kShortestStep = 2e-5;   // of the tool in a frame that says something about the slope [m]
constexpr double kMinEigenvalue = 1e-3;  // of the greatest: softer directions have no equilibrium

// The displacement that takes the force away, in the directions that have a stiffness.
Eigen::Vector3d solveWhereStiff(const Eigen::Matrix3d& stiffness, const Eigen::Vector3d& force) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(stiffness);
  const double min = kMinEigenvalue * eigen.eigenvalues().maxCoeff();
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (int i = 0; i < 3; ++i)
    if (eigen.eigenvalues()[i] > min && min > 0)
      sum += eigen.eigenvectors().col(i) * (eigen.eigenvectors().col(i).dot(force) / eigen.eigenvalues()[i]);
  return sum;
}

}  // namespace

ImpedanceEstimator::ImpedanceEstimator(const ElasticBody& body, double step_period)
    : body_(body), interval_(std::max(1, static_cast<int>(std::lround(kInterval / step_period)))) {
  const auto pattern =
      std::make_shared<const BlockPattern>(blockPattern(body.nodeCount(), body.elements->nodeGroups()));
  const auto plan = makeFactorPlan(*pattern);
  for (auto* stiffness : {&rest_, &made_, &next_}) *stiffness = std::make_unique<StaticStiffness>(body, pattern, plan);
  present_ = rest_->make({}) ? rest_.get() : nullptr;
}

ImpedanceEstimator::~ImpedanceEstimator() {
  if (making_.valid()) making_.wait();
}

std::optional<ToolImpedance> ImpedanceEstimator::update(std::int64_t step, const ToolContactRows& touch,
                                                        const std::array<const double*, 3>& positions,
                                                        const std::vector<float>& gas_direction, double gas_stiffness) {
  const bool consecutive = step == last_step_ + 1;
  if (step <= last_step_ || step > last_step_ + interval_) begin(step, gas_direction, gas_stiffness);
  last_step_ = step;
  setRows(touch);
  if (step >= next_renewal_) {
    next_renewal_ = step + interval_;
    renew(touch, positions, gas_direction, gas_stiffness);
  }
  if (touch.rows.empty() || present_ == nullptr) {
    has_last_ = false;
    return std::nullopt;
  }
  return respond(touch, consecutive);
}

// Whatever an earlier touch has left behind does not count.
void ImpedanceEstimator::begin(std::int64_t step, const std::vector<float>& gas_direction, double gas_stiffness) {
  if (making_.valid()) making_.get();
  next_renewal_ = step;
  linearization_point_.clear();
  mass_.setZero();
  last_nodes_.clear();
  slope_.forget(), joint_slope_.forget();
  if (present_ == nullptr) return;
  present_ = rest_.get();
  rest_->setRows({});
  rest_->setGas(gas_direction, gas_stiffness);
}

// What was begun an interval ago takes over; the next is begun if anything has moved.
void ImpedanceEstimator::renew(const ToolContactRows& touch, const std::array<const double*, 3>& positions,
                               const std::vector<float>& gas_direction, double gas_stiffness) {
  if (making_.valid() && making_.get()) {
    made_.swap(next_);
    present_ = made_.get();
    linearization_point_.swap(next_linearization_point_);
    mass_ = next_mass_;
  }
  const bool lacks_mass = body_.mass_damping > 0 && mass_.isZero() && !touch.rows.empty();
  if (!lacks_mass && !farFrom(positions)) return;
  next_linearization_point_.resize(3 * body_.rest.size());
  for (std::size_t i = 0; i < next_linearization_point_.size(); ++i)
    next_linearization_point_[i] = static_cast<float>(positions[i % 3][i / 3]);
  startMaking(gas_direction, gas_stiffness);
}

void ImpedanceEstimator::startMaking(const std::vector<float>& gas_direction, double gas_stiffness) {
  next_gas_ = gas_direction;
  next_rows_ = rows_;
  next_motion_ = motion_;
  making_ = std::async(std::launch::async, [this, gas_stiffness] {
    if (!next_->make(next_linearization_point_)) return false;
    next_->setRows(next_rows_);
    next_->setGas(next_gas_, gas_stiffness);
    next_mass_.setZero();
    if (body_.mass_damping > 0 && next_rows_.count() > 0) next_mass_ = next_->movingMass(next_motion_);
    return true;
  });
}

bool ImpedanceEstimator::farFrom(const std::array<const double*, 3>& positions) const {
  for (int i = 0; i < body_.nodeCount(); ++i)
    for (int k = 0; k < 3; ++k) {
      const double from =
          linearization_point_.empty() ? body_.rest[i][k] : static_cast<double>(linearization_point_[3 * i + k]);
      if (!(std::abs(positions[k][i] - from) <= kFar)) return true;
    }
  return false;
}

void ImpedanceEstimator::setRows(const ToolContactRows& touch) {
  rows_.equations.clear();
  motion_.resize(static_cast<Eigen::Index>(touch.rows.size()), kToolMotions);
  for (std::size_t r = 0; r < touch.rows.size(); ++r) {
    rows_.equations.add().form.setNode(touch.rows[r].node, touch.rows[r].direction);
    motion_.row(static_cast<Eigen::Index>(r)) = touch.rows[r].motion;
  }
}

std::optional<ToolImpedance> ImpedanceEstimator::respond(const ToolContactRows& touch, bool consecutive) {
  present_->setRows(rows_);
  factor_.compute(present_->compliance());
  solved_.resize(motion_.rows(), kToolMotions);
  for (Eigen::Index c = 0; c < kToolMotions; ++c) solved_.col(c) = factor_.solve(motion_.col(c));
  const Motions found = motion_.transpose().lazyProduct(solved_);
  Motions stiffness = 0.5 * (found + found.transpose());
  if (factor_.info() != Eigen::Success || !factor_.isPositive() || !stiffness.allFinite()) return std::nullopt;

  nodes_.clear();
  for (const ToolRow& row : touch.rows) nodes_.push_back(row.node);
  const bool comparable = touch.smooth && consecutive && nodes_ == last_nodes_;
  has_last_ = has_last_ && consecutive;
  last_nodes_.swap(nodes_);
  return response(touch, stiffness, comparable);
}

// Particles that come into touch and leave it again can make the forces of contacts jump to and fro from frame to
// frame, which a hand would feel as a buzz. While they do, the mean of two frames counts, the earlier force brought to
// the present place by the stiffness.
Eigen::Matrix<double, kToolMotions, 1> ImpedanceEstimator::calmForce(const ToolContactRows& touch,
                                                                     const Eigen::Matrix3d& k_tip,
                                                                     const Eigen::Matrix3d& b_tip,
                                                                     const JointMatrix& k_joints,
                                                                     const JointMatrix& b_joints) {
  Eigen::Matrix<double, kToolMotions, 1> force = touch.force, jump = Eigen::Matrix<double, kToolMotions, 1>::Zero();
  if (has_last_ && touch.contacts) {
    const Eigen::Matrix<double, kToolMotions, 1> moved = touch.place - last_place_, faster = touch.speed - last_speed_;
    jump = touch.force - last_force_;
    jump.head<3>() += k_tip * moved.head<3>() + b_tip * faster.head<3>();
    jump.tail<kScopeJointCount>() +=
        k_joints * moved.tail<kScopeJointCount>() + b_joints * faster.tail<kScopeJointCount>();
    if (jump.head<3>().dot(last_jump_.head<3>()) < 0) force -= 0.5 * jump;
  }
  last_jump_ = jump;
  has_last_ = true;
  last_place_ = touch.place, last_speed_ = touch.speed, last_force_ = touch.force;
  return force;
}

// The stiffness of translations and that of the joints are corrected each along its own motion.
ToolImpedance ImpedanceEstimator::response(const ToolContactRows& touch, const Motions& stiffness, bool comparable) {
  using Joints = Eigen::Matrix<double, kScopeJointCount, 1>;
  const Motions drag = body_.mass_damping * mass_, damping = body_.stiffness_damping * stiffness + drag;
  const Eigen::Matrix<double, kToolMotions, 1>&x = touch.place, &v = touch.speed;
  const Eigen::Vector3d tip = x.head<3>();
  const Joints joints = x.tail<kScopeJointCount>();
  const Eigen::Matrix3d k_tip = stiffness.topLeftCorner<3, 3>(), b_tip = damping.topLeftCorner<3, 3>();
  const JointMatrix k_joints = stiffness.bottomRightCorner<kScopeJointCount, kScopeJointCount>();
  const JointMatrix b_joints = damping.bottomRightCorner<kScopeJointCount, kScopeJointCount>();
  const bool tip_moved = (tip - slope_.lastPlace()).norm() > kShortestStep;
  const Joints turned = joints - joint_slope_.lastPlace();
  double row_move = 0;
  for (Eigen::Index r = 0; r < motion_.rows(); ++r)
    row_move = std::max(row_move, std::abs(motion_.row(r).tail<kScopeJointCount>().dot(turned)));
  const bool joints_moved = row_move > kShortestStep;
  slope_.observe(k_tip, tip, touch.force.head<3>() + b_tip * v.head<3>(), comparable && tip_moved);
  joint_slope_.observe(k_joints, joints, touch.force.tail<kScopeJointCount>() + b_joints * v.tail<kScopeJointCount>(),
                       comparable && joints_moved);

  const Eigen::Matrix<double, kToolMotions, 1> f =
      calmForce(touch, slope_.corrected(k_tip), b_tip, joint_slope_.corrected(k_joints), b_joints);
  ToolImpedance out;
  out.position = tip;
  out.velocity = v.head<3>();
  out.force = f.head<3>();
  out.stiffness = slope_.corrected(k_tip);
  out.damping = body_.stiffness_damping * out.stiffness + drag.topLeftCorner<3, 3>();
  out.equilibrium = tip + solveWhereStiff(out.stiffness, Eigen::Vector3d(out.force + out.damping * out.velocity));
  const JointMatrix corrected = joint_slope_.corrected(k_joints);
  for (int j = 0; j < kScopeJointCount; ++j) {
    JointResponse& joint = out.joints[j];
    joint.position = x[3 + j];
    joint.velocity = v[3 + j];
    joint.effort = f[3 + j];
    joint.stiffness = std::max(0.0, corrected(j, j));
    joint.damping = body_.stiffness_damping * joint.stiffness + drag(3 + j, 3 + j);
    const bool stiff = joint.stiffness > kMinEigenvalue * stiffness(3 + j, 3 + j) && joint.stiffness > 0;
    joint.equilibrium = joint.position;
    if (stiff) joint.equilibrium += (joint.effort + joint.damping * joint.velocity) / joint.stiffness;
  }
  return out;
}

}  // namespace vibe
