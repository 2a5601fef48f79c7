// What the step does with the tool: where it yields to, how far it goes, and what its forces are to the hand.
#include <algorithm>
#include <cmath>

#include "dynamics/implicit_solver.hpp"
#include "model/step_accounts.hpp"
#include "solver/stepper_workspace.hpp"
#include "solver/time_scheme.hpp"
#include "tool/tool_motion.hpp"

namespace vibe {

namespace {

// Share of its way below which a joint counts as stopped. Design choice: a joint that makes a tenth of its way pushes
// on [1].
constexpr double kStopped = 0.1;
// Speed with which the tool at a contact leaves where it was expected, above which the step is solved again. Design
// choice: 0.1 mm at 60 Hz, which turns the normal of a tip by a degree [m/s].
constexpr double kMiss = 6e-3;
// The same above which it is not. Design choice: 1 mm at 60 Hz, a few degrees; a tool that is thrown about is not where
// any guess has it, and the guard keeps it out of the wall [m/s].
constexpr double kFar = 0.06;
// Way to where the tool is then expected, over how far it came in the first direction or in the first solve. Design
// choice: normals turn with the tip that they push aside, and where it slides each solve finds 0.2 to 0.6 of what the
// one before has missed; a direction finds less [1].
constexpr double kFollowForeseen = 2, kFollow = 1.6;
// Times that nodes are held back which would lead a recovering wall through the tool, before the whole wall waits.
// Design choice: what is held back spreads by a ring of triangles each time.
constexpr int kRecoveryAttempts = 8;

}  // namespace

// Where the tool is expected at the end of the step is where it meets the wall, and the tool yields along the
// directions in which it then moves in the middle: its motion along the wall and the work of the forces are right to
// second order.
void ImplicitStep::gatherSprings() {
  const ToolDisplacement& from = motion_->startDisplacement();
  if (!expected_again_) expected_ = expectedDisplacement();
  ToolMotion motion = *motion_;
  motion.displaceEnd(expected_);
  motion.linkPoses(0.5, scratch_.tool.middle);
  motion.linkPoses(1, scratch_.tool.end);
  bend_.emplace(model_.tool->shaftBend(motion.inputs(0.5), motion.displacement(0.5)));
  context_.bend = &*bend_;
  springs_ = model_.scope_springs->during(motion.inputs(0.5), from, motion.displacement(0.5), context_.step);
  ToolYield& yield = scratch_.loads.tool_yield;
  yield = springs_->yield();
  for (int d = 0; d < kYieldDofs; ++d) yield.free[d] -= expected_[d] - from[d];
  yield.displacement = yield.free;
}

// At the end of the step, with the forces of the last one.
ToolDisplacement ImplicitStep::expectedDisplacement() const {
  const ToolDisplacement& from = motion_->startDisplacement();
  const ToolYield yield = model_.scope_springs->during(motion_->inputs(0.5), from, from, context_.step).yield();
  const Eigen::Isometry3d& tip = scratch_.tool.start[model_.tip_link];
  const YieldVector pull =
      yieldForce(*model_.tool, scratch_.tool.start, model_.tool->shaftBend(motion_->inputs(0), from), model_.tip_link,
                 tip.translation(), tip.linear() * state_.tool_force, tip.linear() * state_.tool_torque);
  const YieldVector moved = yield.free + yield.compliance * pull;
  ToolDisplacement end = from;
  for (int d = 0; d < kYieldDofs; ++d) end[d] += moved[d];
  return end;
}

// Whether the forces of the step bring the tool elsewhere than where its contacts were looked for. That is so
// while a tip is pushed aside ever faster: the pull of the last step lags behind.
bool ImplicitStep::missesTool() const {
  if (context_.bend == nullptr) return false;
  double miss = 0;
  for (const ContactConstraint& contact : scratch_.loads.contacts)
    if (!contact.force.isZero())
      miss = std::max(miss, (contact.yield * scratch_.loads.tool_yield.displacement).norm() / context_.step);
  return miss > kMiss && miss < kFar;
}

void ImplicitStep::expectAgain() {
  expected_again_ = true;
  const double follow = refused_ ? kFollowForeseen : kFollow;
  for (int d = 0; d < kYieldDofs; ++d) expected_[d] += follow * scratch_.loads.tool_yield.displacement[d];
  startAgain();
}

// From here on the tool is where the forces of this step have brought it.
void ImplicitStep::yieldTool() {
  yielded_ = *motion_;
  report_.tool_displacement = expected_;
  for (int d = 0; d < kYieldDofs; ++d) report_.tool_displacement[d] += scratch_.loads.tool_yield.displacement[d];
  yielded_->displaceEnd(report_.tool_displacement);
  yielded_->linkPoses(1, scratch_.tool.end);
}

// @returns whether the tool stops, for the first time in the step
bool ImplicitStep::stopsTool() {
  scratch_.held.clear();
  const double whole = wholeWeight(state_.grip);
  for (const GripPoint& point : state_.grip)
    if (point.weight >= whole) scratch_.held.push_back(point.particle);
  const ToolMotion wanted = yielded_ ? *yielded_ : *motion_;
  ToolMotion motion = wanted;
  if (!scratch_.guard->stop(scratch_.tool, motion, pathOfStep(), scratch_.held)) return false;
  limited_ = motion;
  noteStopped(wanted);
  return true;
}

void ImplicitStep::keepToolApart() {
  ToolMotion motion = yielded_ ? *yielded_ : *motion_;
  const double free = limited_ ? scratch_.guard->keepApart(scratch_.tool, motion, pathOfStep(), scratch_.held) : 1;
  tool_stopped_ = limited_.has_value();
  state_.joints = motion.inputs(1);
  if (model_.scope_springs) report_.tool_displacement = motion.displacement(1);
  if (free < 1) stopWall(free);
}

// The joints that hardly come on, and whether nothing of the tool does.
void ImplicitStep::noteStopped(const ToolMotion& wanted) {
  const auto hardly = [](double from, double to, double target) {
    return std::abs(to - from) < kStopped * std::abs(target - from);
  };
  const auto start = limited_->inputs(0), end = limited_->inputs(1), target = wanted.inputs(1);
  bool goes = false;
  for (std::size_t j = 0; j < start.size(); ++j) {
    const bool stopped = hardly(start[j], end[j], target[j]);
    if (stopped) report_.stopped[j] = target[j] > start[j] ? 1 : -1;
    goes = goes || (target[j] != start[j] && !stopped);
  }
  const ToolDisplacement from = limited_->displacement(0), to = limited_->displacement(1);
  for (std::size_t d = 0; d < from.size(); ++d)
    goes = goes || (to[d] != from[d] && !hardly(from[d], to[d], wanted.displacement(1)[d]));
  if (!goes) report_.blocking_particle = scratch_.guard->blockingVertex();
}

// Straight paths of all nodes have been found free of crossings among each other, so they are at any common part of the
// paths as well.
void ImplicitStep::stopWall(double part) {
  for (std::size_t k = 0; k < 3; ++k) {
    std::vector<double>&x = state_.*kMotionOf[k], &v = state_.*kMotionOf[3 + k], &a = state_.*kMotionOf[6 + k];
    for (std::size_t i = 0; i < x.size(); ++i) {
      const double move = part * (x[i] - scratch_.start[k][i]);
      x[i] = scratch_.start[k][i] + move;
      v[i] = move / context_.step;
      a[i] = 0;
    }
  }
}

// The tool goes as far as a wall that stands still lets it; then the wall goes to where it has no tool in its way.
void ImplicitStep::recoverAround() {
  scratch_.held.clear();
  SurfacePath path = pathOfStep();
  path.to = path.from;
  ToolMotion motion = *motion_;
  motion.displaceEnd(report_.tool_displacement);
  scratch_.guard->keepApart(scratch_.tool, motion, path, scratch_.held);
  state_.joints = motion.inputs(1);
  if (model_.scope_springs) report_.tool_displacement = motion.displacement(1);
  const ToolMotion stands(*model_.tool, model_.tool_base, state_.joints, state_.joints, motion.displacement(1));
  ToolPoses there;
  stands.linkPoses(0, there.start);
  for (int attempt = 0; attempt < kRecoveryAttempts; ++attempt) {
    const std::vector<int>& met = scratch_.guard->meets(there, stands, pathOfStep(), scratch_.held);
    if (met.empty()) return;
    for (std::size_t k = 0; k < 3; ++k)
      for (const int i : met) (state_.*kMotionOf[k])[i] = scratch_.start[k][i];
  }
  for (std::size_t k = 0; k < 3; ++k) state_.*kMotionOf[k] = scratch_.start[k];
}

SurfacePath ImplicitStep::pathOfStep() const {
  SurfacePath path;
  for (std::size_t k = 0; k < 3; ++k)
    path.from[k] = scratch_.start[k].data(), path.to[k] = (state_.*kMotionOf[k]).data();
  return path;
}

void ImplicitStep::reportTool() {
  const Eigen::Vector3d tip = scratch_.tool.end[model_.tip_link].translation();
  for (const ToolTouch& touch : scratch_.touches) {
    if (touch.kind == ToolTouch::Kind::Grip) report_.grip_force += touch.force;
    if (touch.kind == ToolTouch::Kind::Contact) ++report_.contact_count;
    state_.energy.friction_loss -= touch.force.dot(touch.motion) + touch.work;
    pushTool(touch.force, touch.point, touch.motion, tip, report_, state_.energy);
    report_.contacts.push_back(touch);
  }
}

// Inputs that are not the scope's act from within the tool: the hand that pushes an instrument. Levers are those half
// way: at the end of the step they would be wrong by what the tool turns in it.
// @param tool_work  of the tool on the tissue in this step [J]
void ImplicitStep::reportHand(double tool_work) {
  Eigen::Matrix<double, kJointCount, 1> effort = Eigen::Matrix<double, kJointCount, 1>::Zero();
  const auto from = motion_->inputs(0), &to = state_.joints;
  ToolMotion motion(*model_.tool, model_.tool_base, from, to, motion_->startDisplacement());
  if (model_.scope_springs) motion.displaceEnd(report_.tool_displacement);
  motion.linkPoses(0.5, scratch_.tool.middle);
  for (const ToolTouch& touch : scratch_.touches)
    effort -= pointJacobian(*model_.tool, scratch_.tool.middle, touch.link, touch.middle).transpose() * touch.force;
  const double scope_loss = state_.energy.scope_loss;
  if (springs_) {
    const ToolDisplacement& after = report_.tool_displacement;
    effort.head<kScopeJointCount>() = springs_->load(after).head<kScopeJointCount>();
    state_.energy.scope_loss += springs_->loss(after);
  }
  double hand_work = 0;
  for (int j = 0; j < kJointCount; ++j) hand_work += effort[j] * (to[j] - from[j]);
  state_.energy.hand_work += hand_work;
  // short of the equilibrium of springs and forces, the scope loses what its springs do beyond the forces
  if ((tool_stopped_ || !report_.arrived) && model_.scope_springs) {
    const double stored = model_.scope_springs->energy(to, report_.tool_displacement) -
                          model_.scope_springs->energy(from, motion_->startDisplacement());
    state_.energy.scope_loss = scope_loss + hand_work - tool_work - stored;
  }
  for (int j = 0; j < kScopeJointCount; ++j) report_.hand_effort[j] = effort[j];
}

// Begins before anything is touched, because the factor that the impedance needs takes a while to make.
void ImplicitStep::reportImpedance() {
  if (!scratch_.wants_impedance || (scratch_.touches.empty() && scratch_.loads.contacts.empty())) return;
  findToolContactRows(model_, *motion_, stepper_, report_, scratch_);
  report_.tool_impedance = scratch_.impedance->update(
      state_.step, scratch_.tool_rows, {state_.x.data(), state_.y.data(), state_.z.data()},
      scratch_.stepper->last.volume_gradient, scratch_.loads.gas.stiffness, state_.impedance);
}

}  // namespace vibe
