#include "dynamics/tool_contact_rows.hpp"

#include "contact/tool_jacobian.hpp"
#include "solver/time_scheme.hpp"

namespace vibe {

namespace {

constexpr double kSticks = 0.999;  // of the greatest friction; what has more slides

using PointMotion = Eigen::Matrix<double, 3, kToolMotions>;

PointMotion pointMotion(const Model& model, const ImplicitScratch& scratch, int link, const Eigen::Vector3d& point) {
  PointMotion motion;
  motion << Eigen::Matrix3d::Identity(),
      pointJacobian(*model.tool, scratch.poses, link, point).leftCols<kScopeJointCount>();
  return motion;
}

void addRow(int node, const Eigen::Vector3d& direction, const PointMotion& motion, ToolContactRows& touch) {
  touch.rows.push_back({node, direction, direction.transpose() * motion});
}

// force: tool on tissue [N]
void addGrip(const Model& model, const GripPoint& point, const Eigen::Vector3d& force, ImplicitScratch& scratch) {
  const Eigen::Vector3d target = scratch.poses[model.grip_link] * point.local;
  const PointMotion motion = pointMotion(model, scratch, model.grip_link, target);
  for (int k = 0; k < 3; ++k) addRow(point.particle, Eigen::Vector3d::Unit(k), motion, scratch.touch);
  scratch.touch.force -= motion.transpose() * force;
}

void addContact(const Model& model, const ContactConstraint& contact, int link, const Eigen::Vector3d& at,
                ImplicitScratch& scratch) {
  const PointMotion motion = pointMotion(model, scratch, link, at);
  const double push = contact.force.dot(contact.normal);
  const double drag = (contact.force - push * contact.normal).norm();
  addRow(contact.node, contact.normal, motion, scratch.touch);
  if (drag < kSticks * contact.friction * push) {
    const Eigen::Vector3d tangent = contact.normal.unitOrthogonal();
    addRow(contact.node, tangent, motion, scratch.touch);
    addRow(contact.node, contact.normal.cross(tangent), motion, scratch.touch);
  }
  scratch.touch.contacts = true;
  scratch.touch.force -= motion.transpose() * contact.force;
}

// The forces are those of a moment before the end of the step.
void findPlace(const Model& model, const ToolMotion& motion, const ImplicitStepper& stepper, bool fallback,
               ImplicitScratch& scratch) {
  StepSettings settings = stepper.settings();
  settings.backward_euler = settings.backward_euler || fallback;
  const double before = TimeScheme(settings, 0, 0).alpha_f;
  const Eigen::Vector3d from = scratch.old_poses[model.tip_link].translation();
  const Eigen::Vector3d to = scratch.poses[model.tip_link].translation();
  ToolContactRows& touch = scratch.touch;
  touch.place.head<3>() = to + before * (from - to);
  touch.speed.head<3>() = (to - from) / settings.step;
  const auto start = motion.inputs(0), place = motion.inputs(1 - before), end = motion.inputs(1);
  for (int j = 0; j < kScopeJointCount; ++j) {
    touch.place[3 + j] = place[j];
    touch.speed[3 + j] = (end[j] - start[j]) / settings.step;
  }
}

}  // namespace

void findToolContactRows(const Model& model, const ToolMotion& motion, const ImplicitStepper& stepper,
                         const StepReport& report, const State& state, ImplicitScratch& scratch) {
  ToolContactRows& touch = scratch.touch;
  touch.rows.clear();
  touch.force.setZero();
  touch.contacts = false;
  touch.smooth = !report.fallback;
  findPlace(model, motion, stepper, report.fallback, scratch);
  const std::vector<LinearConstraint>& held = scratch.loads.constraints;
  for (std::size_t g = 0; g < state.grip.size(); ++g)
    addGrip(model, state.grip[g], {held[3 * g].force, held[3 * g + 1].force, held[3 * g + 2].force}, scratch);
  for (std::size_t c = 0; c < scratch.loads.contacts.size(); ++c) {
    const ContactConstraint& contact = scratch.loads.contacts[c];
    if (contact.force.isZero()) continue;
    const int i = contact.node;
    addContact(model, contact, scratch.contact_link[c], {state.x[i], state.y[i], state.z[i]}, scratch);
  }
}

}  // namespace vibe
