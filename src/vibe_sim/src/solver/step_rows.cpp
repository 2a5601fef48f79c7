#include "step_rows.hpp"

#include <Eigen/Geometry>

namespace vibe {
namespace {

void addContact(const ContactCondition& contact, HalfRow* rows) {
  const Eigen::Vector3d normal = contact.normal, tangent = normal.unitOrthogonal();
  const Eigen::Vector3d directions[3] = {normal, tangent, normal.cross(tangent)};
  for (int k = 0; k < 3; ++k) {
    rows[k].node.assign(1, contact.node);
    rows[k].coefficient.assign(1, directions[k]);
    rows[k].compliance = 0;
    rows[k].friction = contact.friction;
  }
}

double rowTarget(const BodyLoads& loads, const std::vector<HalfRow>& rows, std::size_t r) {
  if (r < loads.conditions.size()) return loads.conditions[r].target;
  const std::size_t k = (r - loads.conditions.size()) % 3;
  const ContactCondition& contact = loads.contacts[(r - loads.conditions.size()) / 3];
  return k == 0 ? contact.offset : rows[r].coefficient[0].dot(contact.anchor);
}

}  // namespace

void buildRows(const BodyLoads& loads, StepperScratch& scratch) {
  std::vector<HalfRow>& rows = scratch.rows;
  rows.resize(loads.conditions.size() + 3 * loads.contacts.size());
  std::size_t r = 0;
  for (const Condition& condition : loads.conditions) {
    rows[r].node = condition.node;
    rows[r].coefficient = condition.coefficient;
    rows[r].compliance = condition.compliance;
    rows[r++].friction = -1;
  }
  for (const ContactCondition& contact : loads.contacts) addContact(contact, &rows[r]), r += 3;
  scratch.target.resize(static_cast<Eigen::Index>(rows.size()));
  scratch.wanted.resize(static_cast<Eigen::Index>(rows.size()));
}

void aimAtEquilibrium(const BodyLoads& loads, StepperScratch& scratch) {
  for (std::size_t r = 0; r < scratch.rows.size(); ++r)
    scratch.target[static_cast<Eigen::Index>(r)] = rowTarget(loads, scratch.rows, r);
}

void aimAtStep(const BodyLoads& loads, const MotionView& motion, const TimeScheme& scheme, StepperScratch& scratch) {
  const double gain = scheme.z_gain / scheme.x_gain;
  for (std::size_t r = 0; r < scratch.rows.size(); ++r) {
    HalfRow& row = scratch.rows[r];
    double lack = rowTarget(loads, scratch.rows, r), free = 0;  // lack: of x at the end without acceleration
    for (std::size_t k = 0; k < row.node.size(); ++k)
      for (int c = 0; c < 3; ++c) {
        const int i = row.node[k];
        const double weight = row.coefficient[k][c];
        lack -= weight * scheme.free_x(motion.x[c][i], motion.v[c][i], motion.a[c][i]);
        free += weight * scheme.free_z(motion.x[c][i], motion.v[c][i], motion.a[c][i]);
      }
    scratch.target[static_cast<Eigen::Index>(r)] = free + gain * lack;
    row.compliance *= gain;
  }
}

void storeForces(const StepperScratch& scratch, BodyLoads& loads) {
  const Eigen::VectorXd& force = scratch.half_space.forces();
  Eigen::Index r = 0;
  for (Condition& condition : loads.conditions) condition.force = force[r++];
  for (ContactCondition& contact : loads.contacts) {
    contact.force.setZero();
    for (int k = 0; k < 3; ++k, ++r)
      contact.force += force[r] * scratch.rows[static_cast<std::size_t>(r)].coefficient[0];
  }
  loads.gas.volume = scratch.volume;
  loads.gas.pressure = scratch.pressure;
}

}  // namespace vibe
