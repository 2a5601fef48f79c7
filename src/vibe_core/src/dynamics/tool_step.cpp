#include "dynamics/tool_step.hpp"

#include <algorithm>
#include <cmath>

#include "dynamics/impedance_rows.hpp"
#include "model/step_accounts.hpp"
#include "solver/stepper_workspace.hpp"
#include "vibe_core/model/accounting.hpp"
#include "vibe_core/model/model.hpp"
#include "vibe_core/solver/step_policy.hpp"

namespace vibe {

ToolStep::ToolStep(const Model& model, const ToolMotion& motion, State& state, ImplicitWorkspace& scratch,
                   StepReport& report)
    : model_(model),
      motion_(&motion),
      state_(state),
      scratch_(scratch),
      report_(report),
      step_(model.scene.step_period),
      still_(motion.inputs(0) == motion.inputs(1)) {}

bool ToolStep::holds() const {
  return still_ && state_.hold.steps * step_ >= stepPolicy().hold_time;
}

void ToolStep::addSprings() {
  motion_->linkPoses(1, scratch_.tool.end);
  if (!model_.scope_springs || limited_) return;
  const ToolDisplacement& from = motion_->startDisplacement();
  if (!aimed_again_) expected_ = expectedDisplacement();
  ToolMotion motion = *motion_;
  motion.displaceEnd(expected_);
  motion.linkPoses(0.5, scratch_.tool.middle);
  motion.linkPoses(1, scratch_.tool.end);
  bend_.emplace(model_.tool->shaftBend(motion.inputs(0.5), motion.displacement(0.5)));
  springs_ = model_.scope_springs->during(motion.inputs(0.5), from, motion.displacement(0.5), step_);
  // the solve counts the tool's displacement from where it is expected
  ToolYield& yield = scratch_.loads.tool_yield;
  yield = springs_->yield();
  for (int d = 0; d < kYieldDofs; ++d) yield.free[d] -= expected_[d] - from[d];
  yield.displacement = yield.free;
}

// At the end of the step, with the forces of the last one. A tool that is held comes to rest where it is: these forces
// vary with those of friction from step to step, and what they make of it would keep the wall going.
ToolDisplacement ToolStep::expectedDisplacement() const {
  const ToolDisplacement& from = motion_->startDisplacement();
  if (holds()) return from;
  const ToolYield yield = model_.scope_springs->during(motion_->inputs(0.5), from, from, step_).yield();
  const YieldVector moved = yield.free + yield.compliance * Eigen::Map<const YieldVector>(state_.tool_load.data());
  ToolDisplacement end = from;
  for (int d = 0; d < kYieldDofs; ++d) end[d] += moved[d];
  return end;
}

bool ToolStep::misses() const {
  if (bend() == nullptr) return false;
  double miss = 0;
  for (const ContactConstraint& contact : scratch_.loads.contacts)
    if (!contact.force.isZero())
      miss = std::max(miss, (contact.yield * scratch_.loads.tool_yield.displacement).norm() / step_);
  return miss > stepPolicy().miss_speed && miss < stepPolicy().far_speed;
}

void ToolStep::reaim(double follow) {
  aimed_again_ = true;
  for (int d = 0; d < kYieldDofs; ++d) expected_[d] += follow * scratch_.loads.tool_yield.displacement[d];
}

void ToolStep::yield() {
  if (bend() == nullptr) return;
  yielded_ = *motion_;
  report_.tool_displacement = expected_;
  for (int d = 0; d < kYieldDofs; ++d) report_.tool_displacement[d] += scratch_.loads.tool_yield.displacement[d];
  yielded_->displaceEnd(report_.tool_displacement);
  yielded_->linkPoses(1, scratch_.tool.end);
}

bool ToolStep::isStopped() {
  if (limited_) return false;
  scratch_.held.clear();
  const double whole = wholeWeight(state_.grip);
  for (const GripPoint& point : state_.grip)
    if (point.weight >= whole) scratch_.held.push_back(point.particle);
  const ToolMotion wanted = yielded_ ? *yielded_ : *motion_;
  ToolMotion motion = wanted;
  const bool overloaded = isOverloaded();
  if (overloaded) motion.moveEnd(NeedleDriver, motion.inputs(0)[NeedleDriver]);
  if (!scratch_.guard->stop(scratch_.tool, motion, pathOfStep(scratch_, state_), scratch_.held) && !overloaded)
    return false;
  limited_ = motion;
  reportStopped(wanted);
  return true;
}

// Whether the drive of the needle arm would have to push harder than it can.
bool ToolStep::isOverloaded() const {
  const double move = motion_->inputs(1)[NeedleDriver] - motion_->inputs(0)[NeedleDriver];
  if (move == 0 || !model_.tool->needleLinkage()) return false;
  double effort = 0;
  for (const ContactConstraint& contact : scratch_.loads.contacts) effort += contact.force.dot(contact.driven);
  return effort * (move > 0 ? 1 : -1) > model_.tool->limits()[NeedleDriver].effort;
}

// The solve had the tool where it does not come to, and the wall out of its way there; where the tool stops, the same
// wall would run into it, and both would stand still for good. Solved again with the tool where it can go, the wall
// makes room for the next step.
void ToolStep::limit() {
  motion_ = &*limited_;
  yielded_.reset();
}

double ToolStep::separate() {
  ToolMotion motion = yielded_ ? *yielded_ : *motion_;
  const double free =
      limited_ ? scratch_.guard->separate(scratch_.tool, motion, pathOfStep(scratch_, state_), scratch_.held) : 1;
  state_.joints = motion.inputs(1);
  if (model_.scope_springs) report_.tool_displacement = motion.displacement(1);
  return free;
}

// The joints that hardly come on, and whether nothing of the tool does.
void ToolStep::reportStopped(const ToolMotion& wanted) {
  const auto hardly = [](double from, double to, double target) {
    return std::abs(to - from) < stepPolicy().stopped_part * std::abs(target - from);
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

void ToolStep::recoverAround() {
  scratch_.held.clear();
  SurfacePath path = pathOfStep(scratch_, state_);
  path.to = path.from;
  ToolMotion motion = *motion_;
  motion.displaceEnd(report_.tool_displacement);
  // the tool moves first, as far as the wall at the start of the step lets it
  scratch_.guard->separate(scratch_.tool, motion, path, scratch_.held);
  state_.joints = motion.inputs(1);
  if (model_.scope_springs) report_.tool_displacement = motion.displacement(1);
  // the tool stands where it came to while the wall goes on
  const ToolMotion stands(*model_.tool, model_.tool_base, state_.joints, state_.joints, motion.displacement(1));
  ToolPoses there;
  there.needle_leads = scratch_.tool.needle_leads;
  stands.linkPoses(0, there.start);
  for (int attempt = 0; attempt < stepPolicy().recovery_attempts; ++attempt) {
    const std::vector<int>& met = scratch_.guard->meets(there, stands, pathOfStep(scratch_, state_), scratch_.held);
    if (met.empty()) return;
    // nodes that wait may stretch triangles over the tool that were free, hence the next attempt
    for (std::size_t k = 0; k < 3; ++k)
      for (const int i : met) (state_.*kMotionOf[k])[i] = scratch_.start[k][i];
  }
  for (std::size_t k = 0; k < 3; ++k) state_.*kMotionOf[k] = scratch_.start[k];
}

void ToolStep::report(const ImplicitStepper& stepper) {
  const double tool_work = state_.energy.tool_work;
  reportForces();
  state_.hold.steps = still_ && report_.contact_count > 0 ? state_.hold.steps + 1 : 0;
  if (model_.scope_springs) reportLoad();
  reportHand(state_.energy.tool_work - tool_work);
  reportImpedance(stepper);
}

void ToolStep::reportForces() {
  const Eigen::Vector3d tip = scratch_.tool.end[model_.tip_link].translation();
  for (const ToolTouch& touch : scratch_.touches) {
    if (touch.kind == ToolTouch::Kind::Grip) report_.grip_force += touch.force;
    if (touch.kind == ToolTouch::Kind::Contact) ++report_.contact_count;
    state_.energy.friction_loss -= touch.force.dot(touch.motion) + touch.work;
    pushTool(touch.force, touch.point, touch.motion, tip, report_, state_.energy);
    report_.contacts.push_back(touch);
  }
}

// What is touched nearer to the hand than a joint does not load that joint: each touch counts with its own link.
void ToolStep::reportLoad() {
  const ShaftBend bend = model_.tool->shaftBend(state_.joints, report_.tool_displacement);
  YieldVector load = YieldVector::Zero();
  for (const ToolTouch& touch : scratch_.touches)
    load += yieldJacobian(*model_.tool, scratch_.tool.end, bend, touch.link, touch.point).transpose() * touch.force;
  for (int d = 0; d < kYieldDofs; ++d) report_.tool_load[d] = load[d];
}

// Inputs that are not the scope's act from within the tool: the hand that pushes an instrument. Levers are those half
// way: at the end of the step they would be wrong by what the tool turns in it.
// @param tool_work  of the tool on the tissue in this step [J]
void ToolStep::reportHand(double tool_work) {
  Eigen::Matrix<double, kJointCount, 1> effort = Eigen::Matrix<double, kJointCount, 1>::Zero();
  const auto from = motion_->inputs(0), &to = state_.joints;
  ToolMotion motion(*model_.tool, model_.tool_base, from, to, motion_->startDisplacement());
  if (model_.scope_springs) motion.displaceEnd(report_.tool_displacement);
  motion.linkPoses(0.5, scratch_.tool.middle);
  for (const ToolTouch& touch : scratch_.touches)
    effort -= pointJacobian(*model_.tool, scratch_.tool.middle, touch.link, touch.middle).transpose() * touch.force;
  const double scope_loss = state_.energy.scope_loss;
  if (springs_) {  // between the hand and the tool, they carry what the hand bears
    const ToolDisplacement& after = report_.tool_displacement;
    effort.head<kScopeJointCount>() = springs_->load(after).head<kScopeJointCount>();
    state_.energy.scope_loss += springs_->loss(after);
  }
  // the hand works only by what it moves: a joint that tissue holds bears a load without work
  double hand_work = 0;
  for (int j = 0; j < kJointCount; ++j) hand_work += effort[j] * (to[j] - from[j]);
  state_.energy.hand_work += hand_work;
  // short of the equilibrium of springs and forces, the scope loses what its springs do beyond the forces
  if ((limited_ || !report_.arrived) && model_.scope_springs) {
    const double stored = model_.scope_springs->energy(to, report_.tool_displacement) -
                          model_.scope_springs->energy(from, motion_->startDisplacement());
    state_.energy.scope_loss = scope_loss + hand_work - tool_work - stored;
  }
  for (int j = 0; j < kScopeJointCount; ++j) report_.hand_effort[j] = effort[j];
}

// Begins before anything is touched, because the factor that the impedance needs takes a while to make.
void ToolStep::reportImpedance(const ImplicitStepper& stepper) {
  if (!scratch_.wants_impedance || (scratch_.touches.empty() && scratch_.loads.contacts.empty())) return;
  findToolContactRows(model_, *motion_, stepper, report_, scratch_);
  report_.tool_impedance = scratch_.impedance->update(
      state_.step, scratch_.tool_rows, {state_.x.data(), state_.y.data(), state_.z.data()},
      scratch_.stepper->iterate.last.volume_gradient, scratch_.loads.gas.stiffness, state_.impedance);
}

}  // namespace vibe
