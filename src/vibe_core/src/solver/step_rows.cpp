#include "solver/step_rows.hpp"

#include <Eigen/Geometry>
#include <algorithm>

#include "suture/capstan.hpp"

namespace vibe {
namespace {

constexpr double kShortestSegment = 1e-6;  // that has a direction [m]
constexpr double kMinTension = 1e-6;       // of a segment's resistance to being turned [N]

void addContact(const ContactConstraint& contact, ConstraintRow* rows) {
  const Eigen::Vector3d normal = contact.normal, tangent = normal.unitOrthogonal();
  const Eigen::Vector3d directions[3] = {normal, tangent, normal.cross(tangent)};
  for (int k = 0; k < 3; ++k) {
    rows[k].node.assign(1, contact.node);
    rows[k].coefficient.assign(1, directions[k]);
    rows[k].compliance = 0;
    rows[k].friction = contact.friction;
    rows[k].thread = rows[k].attachment[0] = -1;
    rows[k].spring = false;
  }
}

Eigen::Vector3d positionOf(const AttachmentPoint& attachment, const MotionView& motion) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < attachment.node.size(); ++i)
    for (int k = 0; k < 3; ++k) sum[k] += attachment.weight[i] * motion.x[k][attachment.node[i]];
  return sum;
}

void addAttachment(const AttachmentPoint& attachment, const Eigen::Vector3d& along, ConstraintRow& row) {
  for (std::size_t i = 0; i < attachment.node.size(); ++i) {
    row.node.push_back(attachment.node[i]);
    row.coefficient.emplace_back(attachment.weight[i] * along);
  }
}

// Between two spots that follow each other, along `along` at the first and against it at the second.
void runBetween(const BodyLoads& loads, int first, const Eigen::Vector3d& along, ConstraintRow& row) {
  row.attachment = {first, first + 1};
  row.along = along;
  row.node.clear(), row.coefficient.clear();
  addAttachment(loads.attachments[first], along, row);
  addAttachment(loads.attachments[first + 1], -along, row);
}

// A tense segment resists being turned: two springs across it. Its direction is that at the start of the step, and what
// turning does to the pull is stiff beside soft tissue.
void addTurning(const BodyLoads& loads, int first, const Eigen::Vector3d& along, double compliance,
                ConstraintRow* rows) {
  const Eigen::Vector3d across = along.unitOrthogonal();
  const Eigen::Vector3d directions[2] = {across, along.cross(across)};
  for (int k = 0; k < 2; ++k) {
    rows[k].thread = -1;
    rows[k].spring = true;
    rows[k].friction = -1;
    rows[k].compliance = compliance;
    runBetween(loads, first, directions[k], rows[k]);
  }
}

// Two spots in one place have no direction between them: then any will do, it pulls nothing that is not there.
Eigen::Vector3d directionOf(const Eigen::Vector3d& between) {
  const double length = between.norm();
  return length > kShortestSegment ? Eigen::Vector3d(between / length) : Eigen::Vector3d(Eigen::Vector3d::UnitX());
}

// Three rows per segment: its pull, which are together since one thread slides as a whole, then all that turn.
void addThread(const BodyLoads& loads, int number, const MotionView& motion, ConstraintRow* rows) {
  const ThreadLoad& thread = loads.threads[number];
  Eigen::Vector3d from = positionOf(loads.attachments[thread.first_attachment], motion), before = from;
  for (std::size_t k = 0; k < thread.length.size(); ++k) {
    const int first = thread.first_attachment + static_cast<int>(k);
    const Eigen::Vector3d to = positionOf(loads.attachments[first + 1], motion);
    ConstraintRow& row = rows[k];
    row.thread = number;
    row.spring = false;
    row.friction = 0;
    row.compliance = std::max(thread.length[k], kMinThread) / thread.stiffness;
    runBetween(loads, first, directionOf(to - from), row);
    const double tension = std::max(thread.tension[k], kMinTension);
    addTurning(loads, first, row.along, std::max((to - from).norm(), kMinThread) / tension,
               rows + thread.length.size() + 2 * k);
    if (k > 0) rows[k - 1].capstan = capstanFactor(thread.friction, turningAngle(before, from, to));
    before = from;
    from = to;
  }
}

std::size_t threadRows(const BodyLoads& loads) {
  std::size_t sum = 0;
  for (const ThreadLoad& thread : loads.threads) sum += 3 * thread.length.size();
  return sum;
}

// Where spots have met, as much thread as they are large stays between them: what slid out of it beyond that comes from
// the nearest segments that have more.
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

double threadTarget(const BodyLoads& loads, std::size_t row) {
  for (const ThreadLoad& thread : loads.threads) {
    const std::size_t segments = thread.length.size();
    if (row < segments) return -std::max(thread.length[row], kMinThread);
    if (row < 3 * segments) return 0;
    row -= 3 * segments;
  }
  return 0;
}

double rowTarget(const BodyLoads& loads, const std::vector<ConstraintRow>& rows, std::size_t r) {
  if (r < loads.constraints.size()) return loads.constraints[r].target;
  const std::size_t threads = loads.constraints.size() + 3 * loads.contacts.size();
  if (r >= threads) return threadTarget(loads, r - threads);
  const std::size_t k = (r - loads.constraints.size()) % 3;
  const ContactConstraint& contact = loads.contacts[(r - loads.constraints.size()) / 3];
  return k == 0 ? contact.offset : rows[r].coefficient[0].dot(contact.anchor);
}

}  // namespace

void buildRows(const BodyLoads& loads, const MotionView& motion, StepperScratch& scratch) {
  std::vector<ConstraintRow>& rows = scratch.rows;
  rows.resize(loads.constraints.size() + 3 * loads.contacts.size() + threadRows(loads));
  std::size_t r = 0;
  for (const LinearConstraint& constraint : loads.constraints) {
    rows[r].node = constraint.node;
    rows[r].coefficient = constraint.coefficient;
    rows[r].compliance = constraint.compliance;
    rows[r].thread = rows[r].attachment[0] = -1;
    rows[r].spring = false;
    rows[r++].friction = -1;
  }
  for (const ContactConstraint& contact : loads.contacts) addContact(contact, &rows[r]), r += 3;
  for (std::size_t t = 0; t < loads.threads.size(); ++t) {
    if (loads.threads[t].length.empty()) continue;
    addThread(loads, static_cast<int>(t), motion, &rows[r]);
    r += 3 * loads.threads[t].length.size();
  }
  scratch.target.resize(static_cast<Eigen::Index>(rows.size()));
  scratch.rhs.resize(static_cast<Eigen::Index>(rows.size()));
}

void setEquilibriumTargets(const BodyLoads& loads, StepperScratch& scratch) {
  for (std::size_t r = 0; r < scratch.rows.size(); ++r)
    scratch.target[static_cast<Eigen::Index>(r)] = rowTarget(loads, scratch.rows, r);
}

void setStepTargets(const BodyLoads& loads, const MotionView& motion, const TimeScheme& scheme,
                    StepperScratch& scratch) {
  const double gain = scheme.z_gain / scheme.x_gain;
  for (std::size_t r = 0; r < scratch.rows.size(); ++r) {
    ConstraintRow& row = scratch.rows[r];
    double residual = rowTarget(loads, scratch.rows, r), free = 0;  // lack: of x at the end without acceleration
    for (std::size_t k = 0; k < row.node.size(); ++k)
      for (int c = 0; c < 3; ++c) {
        const int i = row.node[k];
        const double weight = row.coefficient[k][c];
        residual -= weight * scheme.free_x(motion.x[c][i], motion.v[c][i], motion.a[c][i]);
        free += weight * scheme.free_z(motion.x[c][i], motion.v[c][i], motion.a[c][i]);
      }
    scratch.target[static_cast<Eigen::Index>(r)] = free + gain * residual;
    row.compliance *= gain;
  }
}

void storeForces(const StepperScratch& scratch, double gain, BodyLoads& loads) {
  const Eigen::VectorXd& force = scratch.schur.forces();
  Eigen::Index r = 0;
  for (LinearConstraint& constraint : loads.constraints) constraint.force = force[r++];
  for (ContactConstraint& contact : loads.contacts) {
    contact.force.setZero();
    for (int k = 0; k < 3; ++k, ++r)
      contact.force += force[r] * scratch.rows[static_cast<std::size_t>(r)].coefficient[0];
  }
  for (ThreadLoad& thread : loads.threads) {  // its pulls, then what it has slid
    thread.tension.resize(thread.length.size());
    for (std::size_t k = 0; k < thread.length.size(); ++k, ++r) {
      thread.tension[k] = force[r];
      if (k + 1 == thread.length.size()) continue;
      const double slid = scratch.slid[r] / gain;
      thread.length[k] -= slid;
      thread.length[k + 1] += slid;
    }
    r += 2 * static_cast<Eigen::Index>(thread.length.size());
    fillShortSegments(thread.length);
  }
  loads.gas.volume = scratch.volume;
  loads.gas.pressure = scratch.pressure;
}

}  // namespace vibe
