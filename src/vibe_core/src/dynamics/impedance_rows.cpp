#include "dynamics/impedance_rows.hpp"

#include "solver/time_scheme.hpp"
#include "vibe_core/model/model.hpp"

namespace vibe {

namespace {

using PointMotion = Eigen::Matrix<double, 3, kToolMotions>;

PointMotion pointMotion(const Model& model, const std::vector<Eigen::Isometry3d>& poses, const ToolTouch& touch) {
  PointMotion motion;
  motion << Eigen::Matrix3d::Identity(),
      pointJacobian(*model.tool, poses, touch.link, touch.point).leftCols<kScopeJointCount>();
  return motion;
}

void addTouch(const Model& model, const std::vector<Eigen::Isometry3d>& poses, const ToolTouch& touch,
              ToolContactRows& rows) {
  const PointMotion motion = pointMotion(model, poses, touch);
  for (int k = 0; k < touch.direction_count; ++k) {
    const Eigen::Vector3d& direction = touch.direction[static_cast<std::size_t>(k)];
    rows.rows.push_back({touch.surface, touch.compliance, direction, direction.transpose() * motion, touch.patch});
  }
  if (touch.kind == ToolTouch::Kind::Contact) rows.contacts = true;
  rows.force += motion.transpose() * touch.force;
}

// The forces are those of a moment before the end of the step.
void findPlace(const Model& model, const ToolMotion& motion, const ImplicitStepper& stepper, bool fallback,
               ImplicitWorkspace& scratch) {
  StepSettings settings = stepper.settings();
  settings.backward_euler = settings.backward_euler || fallback;
  const double before = TimeScheme(settings, 0, 0).alpha_f;
  const Eigen::Vector3d from = scratch.tool.start[model.tip_link].translation();
  const Eigen::Vector3d to = scratch.tool.end[model.tip_link].translation();
  ToolContactRows& rows = scratch.tool_rows;
  rows.place.head<3>() = to + before * (from - to);
  rows.speed.head<3>() = (to - from) / settings.step;
  const auto start = motion.inputs(0), place = motion.inputs(1 - before), end = motion.inputs(1);
  for (int j = 0; j < kScopeJointCount; ++j) {
    rows.place[3 + j] = place[j];
    rows.speed[3 + j] = (end[j] - start[j]) / settings.step;
  }
}

}  // namespace

void findToolContactRows(const Model& model, const ToolMotion& motion, const ImplicitStepper& stepper,
                         const StepReport& report, ImplicitWorkspace& scratch) {
  ToolContactRows& rows = scratch.tool_rows;
  rows.rows.clear();
  rows.force.setZero();
  rows.contacts = false;
  rows.smooth = !report.fallback;
  findPlace(model, motion, stepper, report.fallback, scratch);
  for (const ToolTouch& touch : scratch.touches) addTouch(model, scratch.tool.end, touch, rows);
}

}  // namespace vibe
