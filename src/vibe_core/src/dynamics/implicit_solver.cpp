#include "dynamics/implicit_solver.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "arithmetic/elementary.hpp"
#include "solver/time_scheme.hpp"
#include "tool/tool_motion.hpp"
#include "tool_contact/surface_contacts.hpp"
#include "vibe_core/constraints/constraint_registry.hpp"
#include "vibe_core/tissue/shell.hpp"

namespace vibe {

namespace {

// Stretches at which the borne pressure is tabulated. Design choice: to three times the size, where no organ comes.
constexpr double kSpacing = 0.02;
constexpr int kStretches = 100;
// Stretch over that of the limit pressure from which a wall counts as bursting while an insufflator works, whatever the
// pressure: the flow may be too small to keep it. Design choice: a shape other than a sphere reaches its own limit
// before [1].
constexpr double kFarBeyond = 1.25;

}  // namespace

LossLimits::LossLimits(const ShellElements& shell, const std::vector<Eigen::Vector3d>& rest)
    : limit_stretch_(std::numeric_limits<double>::infinity()), limit_pressure_(limit_stretch_) {
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& p : rest) centre += p / static_cast<double>(rest.size());
  std::vector<double> none(3 * rest.size()), volume_gradient(3 * rest.size());
  rest_volume_ = shell.volume(none.data(), volume_gradient.data());
  std::vector<float> u(4 * rest.size()), gradient(4 * rest.size());
  const auto energyAt = [&](double stretch) {
    for (std::size_t i = 0; i < rest.size(); ++i)
      for (int k = 0; k < 3; ++k) u[4 * i + k] = static_cast<float>((stretch - 1) * (rest[i] - centre)[k]);
    double energy = 0;
    for (int piece = 0; piece < shell.pieceCount(); ++piece) energy += shell.evaluate(piece, u.data(), gradient.data());
    return energy;
  };
  unheld_energy_ = 0.1 * energyAt(2);
  double before = energyAt(1);
  for (int k = 0; k < kStretches && rest_volume_ > 0; ++k) {
    const double stretch = 1 + (k + 0.5) * kSpacing, energy = energyAt(1 + (k + 1) * kSpacing);
    pressure_.push_back((energy - before) / kSpacing / (3 * stretch * stretch * rest_volume_));
    before = energy;
  }
  for (std::size_t k = 1; k + 1 < pressure_.size(); ++k)
    if (pressure_[k] > pressure_[k - 1] && pressure_[k] >= pressure_[k + 1]) {
      limit_stretch_ = 1 + (static_cast<double>(k) + 0.5) * kSpacing;
      limit_pressure_ = pressure_[k];
      break;
    }
}

bool LossLimits::bursts(double volume, double pressure, bool filling) const {
  if (!(rest_volume_ > 0) || !(volume > 0)) return false;
  const double stretch = math::cbrt(volume / rest_volume_);
  if (!(stretch > limit_stretch_)) return false;
  const auto at = static_cast<std::size_t>((stretch - 1) / kSpacing);
  const double borne = pressure_[std::min(at, pressure_.size() - 1)];
  return pressure > borne || (filling && stretch > kFarBeyond * limit_stretch_);
}

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

ImplicitSolver::ImplicitSolver(std::shared_ptr<const ShellElements> shell, ElasticBody body, StepSettings settings)
    : shell_(std::move(shell)), stepper_(std::move(body), settings), limits_(*shell_, stepper_.body().rest) {}

std::unique_ptr<SolverWorkspace> ImplicitSolver::makeWorkspace(const Model& model) const {
  auto scratch = std::make_unique<ImplicitWorkspace>();
  scratch->stepper = stepper_.makeWorkspace();
  scratch->blocks = makeConstraintBlocks(model);
  if (model.tool)
    scratch->guard.emplace(*model.tool, model.organ.surface, model.organ.thickness, passableVertices(model.organ));
  if (model.tool)
    scratch->impedance =
        std::make_unique<ImpedanceEstimator>(stepper_.body(), model.scene.step_period, restStiffness());
  return scratch;
}

const RestStiffness& ImplicitSolver::restStiffness() const {
  std::call_once(rest_asked_, [this] { rest_ = std::make_unique<const RestStiffness>(stepper_.body()); });
  return *rest_;
}

void ImplicitSolver::advance(const Model& model, const ToolMotion* motion, bool insufflator_on, State& state,
                             SolverWorkspace& scratch, ThreadPool& pool, StepReport& report) const {
  auto& own = static_cast<ImplicitWorkspace&>(scratch);
  own.stepper->stages = own.stages;
  own.stepper->use(pool, stepper_.body().shell);
  ImplicitStep(model, stepper_, limits_, motion, insufflator_on, state, own, report).run();
}

std::shared_ptr<const void> ImplicitSolver::prepare(const State& state, SolverWorkspace& scratch) const {
  return stepper_.shareFactor(state.solver, *static_cast<ImplicitWorkspace&>(scratch).stepper);
}

}  // namespace vibe
