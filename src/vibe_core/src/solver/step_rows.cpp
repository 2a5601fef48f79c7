#include "solver/step_rows.hpp"

#include <Eigen/Geometry>
#include <algorithm>

#include "arithmetic/ordered_algebra.hpp"
#include "solver/contact_bound.hpp"
#include "solver/couplings.hpp"
#include "suture/capstan.hpp"

namespace vibe {
namespace {

Eigen::Vector3d positionOf(const AttachmentPoint& attachment, const MotionView& motion) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < attachment.node.size(); ++i)
    for (int k = 0; k < 3; ++k) sum[k] += attachment.weight[i] * motion.x[k][attachment.node[i]];
  return sum;
}

void addAttachment(const AttachmentPoint& attachment, const Eigen::Vector3d& along, LinearForm& form) {
  for (std::size_t i = 0; i < attachment.node.size(); ++i) {
    form.node.push_back(attachment.node[i]);
    form.coefficient.emplace_back(attachment.weight[i] * along);
  }
}

// Between two attachment points that follow each other, along `along` at the first and against it at the second.
void runBetween(const BodyLoads& loads, int first, const Eigen::Vector3d& along, LinearForm& form) {
  form.node.clear(), form.coefficient.clear();
  addAttachment(loads.attachments[first], along, form);
  addAttachment(loads.attachments[first + 1], -along, form);
}

// A tense segment resists being turned: two springs across it. Its direction is that at the start of the step, and the
// effect of turning on the pull is stiff beside soft tissue.
void setSegment(const BodyLoads& loads, const ThreadLoad& thread, int k, const Eigen::Vector3d& between,
                SegmentRows& segment) {
  const int first = thread.first_attachment + k;
  segment.along = segmentDirection(between);
  segment.compliance = std::max(thread.length[k], kMinThread) / thread.stiffness;
  runBetween(loads, first, segment.along, segment.pull);
  segment.spare = std::max(0.0, thread.length[k] - kMinThread);
  const Eigen::Vector3d across = segment.along.unitOrthogonal();
  segment.across = {across, segment.along.cross(across)};
  segment.turn_compliance = segment.turn_missing = turnCompliance(between.norm(), thread.tension[k]);
  for (std::size_t j = 0; j < 2; ++j) runBetween(loads, first, segment.across[j], segment.turn[j]);
}

void setThread(const BodyLoads& loads, const ThreadLoad& thread, const MotionView& motion, ThreadRows& rows) {
  rows.first_attachment = thread.first_attachment;
  rows.segments.clear();
  if (thread.length.empty()) return;
  Eigen::Vector3d from = positionOf(loads.attachments[thread.first_attachment], motion), before = from;
  for (int k = 0; k < static_cast<int>(thread.length.size()); ++k) {
    const Eigen::Vector3d to = positionOf(loads.attachments[thread.first_attachment + k + 1], motion);
    if (k > 0) rows.segments.back().capstan = capstanFactor(thread.friction, turningAngle(before, from, to));
    setSegment(loads, thread, k, to - from, rows.segments.add());
    before = from;
    from = to;
  }
}

void setContact(const BodyLoads& loads, std::size_t load, ContactRows& rows) {
  const ContactConstraint& contact = loads.contacts[load];
  const Eigen::Vector3d normal = contact.normal, tangent = normal.unitOrthogonal();
  rows.direction = {normal, tangent, normal.cross(tangent)};
  for (std::size_t k = 0; k < 3; ++k) {
    rows.form[k].setPoint(contact.point, rows.direction[k]);
    rows.guess[k] = rows.direction[k].dot(contact.force);
  }
  rows.friction = contact.friction;
  rows.load = load;
  rows.compliance = contact.compliance;
  for (int k = 0; k < 3; ++k)
    rows.yield.row(k) = rows.direction[static_cast<std::size_t>(k)].transpose() * contact.yield;
}

// Where attachment points have met, as much thread as they are large stays between them. What slid out beyond that
// comes from the nearest segments that have more.
void fillShortSegments(std::vector<double>& length) {
  const auto count = static_cast<int>(length.size());
  for (int k = 0; k < count; ++k)
    for (int away = 1; away < count && length[k] < kMinThread; ++away)
      for (const int from : {k - away, k + away}) {
        if (from < 0 || from >= count) continue;
        const double moved = std::clamp(length[from] - kMinThread, 0.0, std::max(0.0, kMinThread - length[k]));
        length[from] -= moved;
        length[k] += moved;
      }
}

// Target of each row for the positions at the end of the step.
void setTargets(const BodyLoads& loads, const ConstraintRows& rows, Eigen::VectorXd& target) {
  target.setZero(rows.count());
  for (std::size_t i = 0; i < loads.constraints.size(); ++i) target[i] = loads.constraints[i].target;
  for (std::size_t c = 0; c < rows.counted; ++c) {
    const ContactConstraint& contact = loads.contacts[rows.contacts[c].load];
    const int row = rows.contactRow(c);
    target[row] = contact.offset;
    for (int k = 1; k < 3; ++k) target[row + k] = rows.contacts[c].direction[k].dot(contact.anchor);
  }
  for (std::size_t t = 0; t < loads.threads.size(); ++t)
    for (int k = 0; k < rows.threads[t].count(); ++k)
      target[rows.threads[t].pullRow(k)] = -std::max(loads.threads[t].length[k], kMinThread);
  rows.forEachYield([&](int row, const YieldVector& yield) { target[row] += fixedDot(yield, loads.tool_yield.free); });
}

// A target for z from one for x at the end of the step.
double stepTarget(const LinearForm& form, double target, const MotionView& motion, const TimeScheme& scheme) {
  double residual = target, free = 0;  // residual: of x at the end without acceleration
  for (std::size_t k = 0; k < form.node.size(); ++k)
    for (int c = 0; c < 3; ++c) {
      const int i = form.node[k];
      const double weight = form.coefficient[k][c];
      residual -= weight * scheme.free_x(motion.x[c][i], motion.v[c][i], motion.a[c][i]);
      free += weight * scheme.free_z(motion.x[c][i], motion.v[c][i], motion.a[c][i]);
    }
  return free + scheme.z_gain / scheme.x_gain * residual;
}

void scaleSegment(double gain, SegmentRows& segment) {
  segment.compliance *= gain;
  segment.spare *= gain;
  segment.turn_compliance *= gain;
  segment.turn_missing *= gain;
}

void scaleCompliances(double gain, ConstraintRows& rows) {
  for (EquationRow& row : rows.equations) row.compliance *= gain;
  for (ContactRows& contact : rows.contacts) contact.compliance *= gain;
  rows.tool_compliance *= gain;
  for (ThreadRows& thread : rows.threads)
    for (SegmentRows& segment : thread.segments) scaleSegment(gain, segment);
}

void storeThread(const RowSystem& system, const ThreadRows& rows, double gain, ThreadLoad& thread) {
  thread.tension.resize(thread.length.size());
  for (int k = 0; k < rows.count(); ++k) {
    thread.tension[k] = system.schur.forces()[rows.pullRow(k)];
    thread.length[k] -= system.unknowns.lost()[rows.pullRow(k)] / gain;
  }
  fillShortSegments(thread.length);
}

}  // namespace

void buildRows(const BodyLoads& loads, const MotionView& motion, RowSystem& system) {
  ConstraintRows& rows = system.rows;
  rows.clear();
  for (const LinearConstraint& constraint : loads.constraints) {
    EquationRow& row = rows.equations.add();
    row.form.node = constraint.node;
    row.form.coefficient = constraint.coefficient;
    row.compliance = constraint.compliance;
    row.yield = constraint.yield;
  }
  for (std::size_t c = 0; c < loads.contacts.size(); ++c) setContact(loads, c, rows.contacts.add());
  for (const ThreadLoad& thread : loads.threads) setThread(loads, thread, motion, rows.threads.add());
  rows.tool_yields = loads.tool_yield.dofs > 0;
  if (rows.tool_yields) rows.tool_compliance = loads.tool_yield.compliance;
  rows.number();
  system.target.resize(rows.count());
  system.rhs.resize(rows.count());
}

void setEquilibriumTargets(const BodyLoads& loads, const std::vector<double>& z, RowSystem& system) {
  setTargets(loads, system.rows, system.target);
  if (limitContacts(z, system)) setTargets(loads, system.rows, system.target);
}

void setTargetsOfStep(const BodyLoads& loads, const MotionView& motion, const TimeScheme& scheme, RowSystem& system) {
  const auto set = [&](int row, const LinearForm& form) {
    system.target[row] = stepTarget(form, system.target[row], motion, scheme);
  };
  setTargets(loads, system.rows, system.target);
  system.rows.forEachMultiplier(set);
  system.rows.forEachSpring([&set](int row, const LinearForm& form, double) { set(row, form); });
}

void setStepTargets(const BodyLoads& loads, const MotionView& motion, const TimeScheme& scheme,
                    const std::vector<StiffnessCoupling>& in_factor, const std::vector<double>& z, RowSystem& system) {
  setTargetsOfStep(loads, motion, scheme, system);
  scaleCompliances(scheme.z_gain / scheme.x_gain, system.rows);
  findMissingTurns(loads, in_factor, system.rows);
  if (limitContacts(z, system)) setTargetsOfStep(loads, motion, scheme, system);
}

void storeToolForces(const RowSystem& system, BodyLoads& loads) {
  const Eigen::VectorXd& force = system.schur.forces();
  const ConstraintRows& rows = system.rows;
  for (ContactConstraint& contact : loads.contacts) contact.force.setZero();
  for (std::size_t c = 0; c < rows.counted; ++c) {
    ContactConstraint& contact = loads.contacts[rows.contacts[c].load];
    for (int k = 0; k < 3; ++k) contact.force += force[rows.contactRow(c) + k] * rows.contacts[c].direction[k];
    contact.used_friction = rows.contacts[c].friction;
  }
  YieldVector pull = YieldVector::Zero();
  rows.forEachYield([&](int row, const YieldVector& yield) { pull += force[row] * yield; });
  if (rows.tool_yields) loads.tool_yield.displacement = loads.tool_yield.free - loads.tool_yield.compliance * pull;
}

void storeForces(const RowSystem& system, double gain, BodyLoads& loads) {
  storeToolForces(system, loads);
  const Eigen::VectorXd& force = system.schur.forces();
  const ConstraintRows& rows = system.rows;
  for (std::size_t i = 0; i < loads.constraints.size(); ++i) loads.constraints[i].force = force[i];
  for (std::size_t t = 0; t < loads.threads.size(); ++t) storeThread(system, rows.threads[t], gain, loads.threads[t]);
}

}  // namespace vibe
