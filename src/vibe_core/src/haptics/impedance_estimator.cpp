#include "haptics/impedance_estimator.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "arithmetic/symmetric_eigen.hpp"
#include "sparse/factor_plan.hpp"
#include "vibe_core/files/fnv1a.hpp"
#include "vibe_core/solver/step_policy.hpp"

namespace vibe {

namespace {

// Steps between two renewals: as the factor of the steps, this one must not keep them waiting.
int renewalSteps(const RestStiffness& rest, double step_period) {
  const double interval =
      std::max(stepPolicy().haptic_interval, stepPolicy().haptic_double_cost * rest.plan->operations / kFactorRate);
  return std::max(1, static_cast<int>(std::lround(interval / step_period)));
}

// The displacement that relieves the force, in the directions that have a stiffness.
Eigen::Vector3d solveWhereStiff(const Eigen::Matrix3d& stiffness, const Eigen::Vector3d& force) {
  const SymmetricEigen3 eigen(stiffness);
  const double min = stepPolicy().haptic_least_stiffness * eigen.values.maxCoeff();
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (int i = 0; i < 3; ++i)
    if (eigen.values[i] > min && min > 0)
      sum += eigen.vectors.col(i) * (eigen.vectors.col(i).dot(force) / eigen.values[i]);
  return sum;
}

std::uint64_t idOf(const ImpedanceBasis& basis) {
  Fnv1a hash;
  hash.addWords(basis.positions.data(), basis.positions.size());
  hash.addWords(basis.gas_direction.data(), basis.gas_direction.size());
  hash.add(&basis.gas_stiffness, sizeof basis.gas_stiffness);
  hash.add(basis.node.data(), basis.node.size() * sizeof(int));
  for (const Eigen::Vector3d& direction : basis.direction) hash.add(direction.data(), 3 * sizeof(double));
  for (const auto& motion : basis.row_motion) hash.add(motion.data(), sizeof motion);
  return std::max<std::uint64_t>(1, hash.result());
}

// Empties a basis, but keeps the capacity of its lists.
void clear(ImpedanceBasis& basis) {
  basis.id = 0;
  basis.positions.clear();
  basis.gas_direction.clear();
  basis.gas_stiffness = 0;
  basis.node.clear();
  basis.direction.clear();
  basis.row_motion.clear();
}

template <class Point>
int heaviestNode(const Point& point) {
  const auto most = std::max_element(point.weight.begin(), point.weight.end());
  return point.node[static_cast<std::size_t>(most - point.weight.begin())];
}

int nearestNode(const ToolRow& row) {
  return row.patch ? heaviestNode(*row.patch) : heaviestNode(row.surface);
}

template <class Point>
void setRow(const Point& point, const Eigen::Vector3d& direction, double compliance, EquationRow& row) {
  row.form.setPoint(point, direction);
  row.compliance = compliance;
}

void listNodes(const ToolContactRows& touch, std::vector<int>& nodes) {
  nodes.clear();
  for (const ToolRow& row : touch.rows)
    if (row.patch)
      nodes.insert(nodes.end(), row.patch->node.begin(), row.patch->node.end());
    else
      nodes.insert(nodes.end(), row.surface.node.begin(), row.surface.node.end());
}

void setGas(const std::vector<float>& direction, double stiffness, ImpedanceBasis& basis) {
  basis.gas_direction = direction;
  basis.gas_stiffness = stiffness;
}

template <std::size_t N>
Eigen::Map<Eigen::Matrix<double, static_cast<int>(N), 1>> asVector(std::array<double, N>& values) {
  return Eigen::Map<Eigen::Matrix<double, static_cast<int>(N), 1>>(values.data());
}

}  // namespace

ImpedanceEstimator::ImpedanceEstimator(const ElasticBody& body, double step_period, const RestStiffness& rest)
    : body_(body),
      interval_(renewalSteps(rest, step_period)),
      making_([this] { make(next_basis_, next_nodes_, next_); }) {
  for (Made* made : {&rest_, &current_, &next_}) made->stiffness = std::make_unique<StaticStiffness>(body, rest);
  rest_.usable = rest.factor != nullptr;
}

std::optional<ToolImpedance> ImpedanceEstimator::update(std::int64_t step, const ToolContactRows& touch,
                                                        const std::array<const double*, 3>& positions,
                                                        const std::vector<float>& gas_direction, double gas_stiffness,
                                                        ImpedanceMemory& memory) {
  // After a pause as long as an interval, or where time has gone back, nothing of the past holds.
  const bool consecutive = step - 1 == memory.last_step;
  if (step <= memory.last_step || step > memory.last_step + interval_)
    begin(step, gas_direction, gas_stiffness, memory);
  memory.last_step = step;
  setRows(touch);
  provide(memory);
  if (step >= memory.next_renewal) {
    memory.next_renewal = step + interval_;
    renew(touch, positions, gas_direction, gas_stiffness, memory);
  }
  if (touch.rows.empty() || present_ == nullptr) {
    memory.has_last = false;
    return std::nullopt;
  }
  return respond(touch, consecutive, memory);
}

// Nothing of an earlier touch counts.
void ImpedanceEstimator::begin(std::int64_t step, const std::vector<float>& gas_direction, double gas_stiffness,
                               ImpedanceMemory& memory) {
  memory.next_renewal = step;
  clear(memory.next);
  clear(memory.current);
  setGas(gas_direction, gas_stiffness, memory.current);
  memory.current.id = idOf(memory.current);
  memory.last_nodes.clear();
  SlopeCorrection<3>(memory.slope).forget();
  SlopeCorrection<kScopeJointCount>(memory.joint_slope).forget();
}

// The stiffness begun an interval ago takes over; the next is begun if anything has moved.
void ImpedanceEstimator::renew(const ToolContactRows& touch, const std::array<const double*, 3>& positions,
                               const std::vector<float>& gas_direction, double gas_stiffness, ImpedanceMemory& memory) {
  if (memory.next.id != 0) {
    finishNext();
    if (next_.usable) std::swap(memory.current, memory.next);
    clear(memory.next);
    provide(memory);
  }
  // The first touch asks for the moving mass, which needs rows; later ones for a stiffness of the wall as it is now.
  const bool has_mass = present_ != nullptr && !present_->mass.isZero();
  const bool lacks_mass = body_.mass_damping > 0 && !has_mass && !touch.rows.empty();
  if (!lacks_mass && !farFrom(memory.current.positions, positions)) return;
  ImpedanceBasis& next = memory.next;
  next.positions.resize(3 * body_.rest.size());
  for (std::size_t i = 0; i < next.positions.size(); ++i)
    next.positions[i] = static_cast<float>(positions[i % 3][i / 3]);
  setGas(gas_direction, gas_stiffness, next);
  // The rows of now stand for those of the time at which the basis is used: at their nearest nodes.
  for (const ToolRow& row : touch.rows) {
    next.node.push_back(nearestNode(row));
    next.direction.push_back(row.direction);
    asVector(next.row_motion.emplace_back()) = row.motion.transpose();
  }
  next.id = idOf(next);
  listNodes(touch, nodes_);
  makeInBackground(next, nodes_);
}

// Makes or finds the stiffness of the current basis, and has the next one made. After a step of the same session both
// are there already.
void ImpedanceEstimator::provide(const ImpedanceMemory& memory) {
  const ImpedanceBasis& basis = memory.current;
  if (basis.positions.empty()) {
    provideAtRest(basis);
  } else {
    // Usually the next one, made in the background, takes over; after a jump in time it is made here.
    if (current_.id != basis.id && next_.id == basis.id) {
      finishNext();
      std::swap(current_, next_);
      next_.id = 0;
    }
    if (current_.id != basis.id) {
      current_.id = basis.id;
      make(basis, {}, current_);
    }
    present_ = current_.usable ? &current_ : nullptr;
  }
  if (memory.next.id != 0 && next_.id != memory.next.id) makeInBackground(memory.next, memory.last_nodes);
}

void ImpedanceEstimator::provideAtRest(const ImpedanceBasis& basis) {
  present_ = rest_.usable ? &rest_ : nullptr;
  if (!rest_.usable || rest_.id == basis.id) return;
  rest_.id = basis.id;
  rest_.stiffness->setRows({});
  rest_.stiffness->setGas(basis.gas_direction, basis.gas_stiffness);
}

void ImpedanceEstimator::finishNext() {
  making_.finish();
}

void ImpedanceEstimator::makeInBackground(const ImpedanceBasis& basis, const std::vector<int>& nodes) {
  finishNext();
  next_basis_ = basis;
  next_nodes_.clear();
  std::copy_if(nodes.begin(), nodes.end(), std::back_inserter(next_nodes_), [](int node) { return node >= 0; });
  next_.id = basis.id;
  making_.start();
}

// @param nodes  that rows will probably have when it is used: their columns are made as well
void ImpedanceEstimator::make(const ImpedanceBasis& basis, const std::vector<int>& nodes, Made& out) const {
  out.mass.setZero();
  out.usable = out.stiffness->make(basis.positions);
  if (!out.usable) return;
  ConstraintRows rows;
  Eigen::MatrixXd motion(static_cast<Eigen::Index>(basis.node.size()), kToolMotions);
  for (std::size_t r = 0; r < basis.node.size(); ++r) {
    setRow(SurfacePoint::ofNode(basis.node[r]), basis.direction[r], stepPolicy().haptic_firm, rows.equations.add());
    for (std::size_t m = 0; m < kToolMotions; ++m) motion(static_cast<Eigen::Index>(r), m) = basis.row_motion[r][m];
  }
  out.stiffness->setRows(rows);
  out.stiffness->setGas(basis.gas_direction, basis.gas_stiffness);
  if (body_.mass_damping > 0 && rows.count() > 0) out.mass = out.stiffness->movingMass(motion);
  out.stiffness->prepare(nodes);
}

bool ImpedanceEstimator::farFrom(const std::vector<float>& linearization_point,
                                 const std::array<const double*, 3>& positions) const {
  const double far = stepPolicy().haptic_far;
  for (int i = 0; i < body_.nodeCount(); ++i)
    for (int k = 0; k < 3; ++k) {
      const double from =
          linearization_point.empty() ? body_.rest[i][k] : static_cast<double>(linearization_point[3 * i + k]);
      if (!(std::abs(positions[k][i] - from) <= far)) return true;
    }
  return false;
}

void ImpedanceEstimator::setRows(const ToolContactRows& touch) {
  rows_.equations.clear();
  motion_.resize(static_cast<Eigen::Index>(touch.rows.size()), kToolMotions);
  for (std::size_t r = 0; r < touch.rows.size(); ++r) {
    const ToolRow& row = touch.rows[r];
    EquationRow& equation = rows_.equations.add();
    if (row.patch)
      setRow(*row.patch, row.direction, row.compliance, equation);
    else
      setRow(row.surface, row.direction, row.compliance, equation);
    motion_.row(static_cast<Eigen::Index>(r)) = touch.rows[r].motion;
  }
}

std::optional<ToolImpedance> ImpedanceEstimator::respond(const ToolContactRows& touch, bool consecutive,
                                                         ImpedanceMemory& memory) {
  // Equation (21): K = P^T C^-1 P, made symmetric against rounding.
  present_->stiffness->setRows(rows_);
  factor_.compute(present_->stiffness->compliance());
  solved_ = motion_;
  for (Eigen::Index c = 0; c < kToolMotions; ++c) factor_.solve(solved_.col(c));
  const Motions found = motion_.transpose().lazyProduct(solved_);
  Motions stiffness = 0.5 * (found + found.transpose());
  if (!factor_.succeeded() || !factor_.isPositive() || !stiffness.allFinite()) return std::nullopt;

  // A slope may be taken between two steps that touch the same nodes and are not exceptional.
  listNodes(touch, nodes_);
  const bool comparable = touch.smooth && consecutive && nodes_ == memory.last_nodes;
  memory.has_last = memory.has_last && consecutive;
  memory.last_nodes.swap(nodes_);
  return response(touch, stiffness, comparable, memory);
}

// Particles that gain and lose contact can make the contact forces alternate from frame to frame, which a hand would
// feel as a buzz. While they alternate, the output is the mean of two frames, with the earlier force extrapolated to
// the present position by the stiffness.
Eigen::Matrix<double, kToolMotions, 1> ImpedanceEstimator::calmForce(
    const ToolContactRows& touch, const Eigen::Matrix3d& k_tip, const Eigen::Matrix3d& b_tip,
    const JointMatrix& k_joints, const JointMatrix& b_joints, ImpedanceMemory& memory) const {
  auto last_place = asVector(memory.last_place), last_speed = asVector(memory.last_speed);
  auto last_force = asVector(memory.last_force), last_jump = asVector(memory.last_jump);
  // A jump is what the force has changed beyond the slope; two of opposite sign in a row are an alternation.
  MotionVector force = touch.force, jump = MotionVector::Zero();
  if (memory.has_last && touch.contacts) {
    const MotionVector moved = touch.place - last_place, faster = touch.speed - last_speed;
    jump = touch.force - last_force;
    jump.head<3>() += k_tip * moved.head<3>() + b_tip * faster.head<3>();
    jump.tail<kScopeJointCount>() +=
        k_joints * moved.tail<kScopeJointCount>() + b_joints * faster.tail<kScopeJointCount>();
    if (jump.head<3>().dot(last_jump.head<3>()) < 0) force -= 0.5 * jump;
  }
  last_jump = jump;
  memory.has_last = true;
  last_place = touch.place, last_speed = touch.speed, last_force = touch.force;
  return force;
}

// The stiffness of translations and that of the joints are corrected each along its own motion.
ToolImpedance ImpedanceEstimator::response(const ToolContactRows& touch, const Motions& stiffness, bool comparable,
                                           ImpedanceMemory& memory) {
  using Joints = Eigen::Matrix<double, kScopeJointCount, 1>;
  SlopeCorrection<3> slope(memory.slope);
  SlopeCorrection<kScopeJointCount> joint_slope(memory.joint_slope);
  const Motions drag = body_.mass_damping * present_->mass, damping = body_.stiffness_damping * stiffness + drag;
  const Eigen::Matrix<double, kToolMotions, 1>&x = touch.place, &v = touch.speed;
  const Eigen::Vector3d tip = x.head<3>();
  const Joints joints = x.tail<kScopeJointCount>();
  const Eigen::Matrix3d k_tip = stiffness.topLeftCorner<3, 3>(), b_tip = damping.topLeftCorner<3, 3>();
  const JointMatrix k_joints = stiffness.bottomRightCorner<kScopeJointCount, kScopeJointCount>();
  const JointMatrix b_joints = damping.bottomRightCorner<kScopeJointCount, kScopeJointCount>();
  // Slopes are taken from moves that are long enough; of the joints, by how far they move any row.
  const double least_step = stepPolicy().haptic_least_step;
  const bool tip_moved = (tip - slope.lastPosition()).norm() > least_step;
  const Joints turned = joints - joint_slope.lastPosition();
  double row_move = 0;
  for (Eigen::Index r = 0; r < motion_.rows(); ++r)
    row_move = std::max(row_move, std::abs(fixedDot(motion_.row(r).tail<kScopeJointCount>().transpose(), turned)));
  const bool joints_moved = row_move > least_step;
  slope.observe(k_tip, tip, touch.force.head<3>() + b_tip * v.head<3>(), comparable && tip_moved);
  joint_slope.observe(k_joints, joints, touch.force.tail<kScopeJointCount>() + b_joints * v.tail<kScopeJointCount>(),
                      comparable && joints_moved);

  const Eigen::Matrix<double, kToolMotions, 1> f =
      calmForce(touch, slope.corrected(k_tip), b_tip, joint_slope.corrected(k_joints), b_joints, memory);
  // The tip's equilibrium is where its force vanishes along directions that have a stiffness, at a tip that stands
  // still.
  ToolImpedance out;
  out.position = tip;
  out.velocity = v.head<3>();
  out.force = f.head<3>();
  out.stiffness = slope.corrected(k_tip);
  out.damping = body_.stiffness_damping * out.stiffness + drag.topLeftCorner<3, 3>();
  out.equilibrium = tip + solveWhereStiff(out.stiffness, Eigen::Vector3d(out.force + out.damping * out.velocity));
  // Each joint is rendered by a motor of its own: what couples them is left out.
  const JointMatrix corrected = joint_slope.corrected(k_joints);
  for (int j = 0; j < kScopeJointCount; ++j) {
    JointResponse& joint = out.joints[j];
    joint.position = x[3 + j];
    joint.velocity = v[3 + j];
    joint.effort = f[3 + j];
    joint.stiffness = std::max(0.0, corrected(j, j));
    joint.damping = body_.stiffness_damping * joint.stiffness + drag(3 + j, 3 + j);
    const bool stiff =
        joint.stiffness > stepPolicy().haptic_least_stiffness * stiffness(3 + j, 3 + j) && joint.stiffness > 0;
    joint.equilibrium = joint.position;
    if (stiff) joint.equilibrium += (joint.effort + joint.damping * joint.velocity) / joint.stiffness;
  }
  return out;
}

}  // namespace vibe
