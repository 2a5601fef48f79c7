#include "dynamics/implicit_solver.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "common/elementary.hpp"
#include "contact/tool_motion.hpp"
#include "geometry/surface_operators.hpp"
#include "model/step_accounts.hpp"
#include "solver/stepper_workspace.hpp"
#include "vibe_core/model/accounting.hpp"

namespace vibe {

namespace {

// Below this speed tissue counts as at rest. Design choice: a micrometre in half a second, far below what a camera or a
// hand resolves [m/s].
constexpr double kRestSpeed = 2e-6;
// Steps at rest before the tissue sleeps. Design choice: a quarter of a second, longer than a slow oscillation stays
// near its turning point at this speed.
constexpr int kRestSteps = 15;
// A sleeping tissue is computed once in this many steps. Design choice: the state may have come from another scene, in
// which it was at rest; half a second passes until that shows.
constexpr int kWakeEvery = 30;
// Time in which lost tissue is led back to rest. Design choice: short, but long enough to be seen as a motion [s].
constexpr double kRecoveryTime = 0.5;
// Rate of the exponential approach to rest. Design choice: e^-10 of the distance remains after kRecoveryTime [1/s].
constexpr double kRecoveryRate = 20;
// Times that nodes are held back which would lead a recovering wall through the tool, before the whole wall waits.
// Design choice: what is held back spreads by a ring of triangles each time.
constexpr int kRecoveryAttempts = 8;
// Steps between checks for an organ that is inside out. Design choice: the check costs a pass over all triangles.
constexpr int kCheckEvery = 10;

// Share of the wall's tension that the gas has to bear for a state to count as held by it. Design choice: half; the
// rest is motion and what else pulls.
constexpr double kHeldPart = 0.5;

// Share of its way below which a joint counts as stopped. Design choice: a joint that makes a tenth of its way pushes
// on [1].
constexpr double kStopped = 0.1;

// Positions, velocities, accelerations of the nodes.
constexpr std::size_t kMotion = 9;
constexpr std::array<std::vector<double> State::*, kMotion> kMotionOf{
    &State::x, &State::y, &State::z, &State::vx, &State::vy, &State::vz, &State::ax, &State::ay, &State::az};

void stopMotion(State& state) {
  for (std::size_t k = 3; k < kMotion; ++k) std::fill((state.*kMotionOf[k]).begin(), (state.*kMotionOf[k]).end(), 0.0);
}

}  // namespace

ImplicitStep::ImplicitStep(const Model& model, const ImplicitStepper& stepper, const LossLimits& limits,
                           const ToolMotion* motion, bool insufflator_on, State& state, ImplicitWorkspace& scratch,
                           StepReport& report)
    : model_(model),
      stepper_(stepper),
      limits_(limits),
      motion_(motion),
      state_(state),
      report_(report),
      scratch_(scratch),
      context_{model, state, model.scene.step_period, motion != nullptr ? &scratch.tool : nullptr, insufflator_on} {}

void ImplicitStep::run() {
  const Activity activity = gather();
  if (asleep(activity)) return;
  begin();
  if (state_.solver.recovery_steps == 0 && lost()) {
    report_.put_back = true;
    state_.solver.recovery_steps = std::max(1, static_cast<int>(std::lround(kRecoveryTime / context_.step)));
  }
  if (state_.solver.recovery_steps > 0) return recover();
  if (!solve()) return;
  if (!keepApart()) {
    giveWay();
    if (!solve()) return;
    keepApart();
  }
  store();
  updateRest(activity);
}

// @returns the most active of the blocks' answers
Activity ImplicitStep::gather() {
  if (motion_ != nullptr) motion_->linkPoses(1, scratch_.tool.end);
  scratch_.loads.clear();
  if (motion_ != nullptr && model_.scope_springs && !limited_) gatherSprings();
  Activity most = Activity::Sleep;
  for (const auto& block : scratch_.blocks) most = std::max(most, block->prepare(context_, scratch_.loads));
  return most;
}

void ImplicitStep::begin() {
  for (const auto& block : scratch_.blocks) block->begin(context_, scratch_.loads);
}

// Where the tool is expected at the end of the step is where it meets the wall, and the tool yields along the
// directions in which it then moves in the middle: its motion along the wall and the work of the forces are right to
// second order.
void ImplicitStep::gatherSprings() {
  const ToolDisplacement& from = motion_->startDisplacement();
  expected_ = expectedDisplacement();
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

bool ImplicitStep::asleep(Activity activity) const {
  return activity == Activity::Sleep && state_.solver.rest_steps >= kRestSteps && state_.step % kWakeEvery != 0;
}

// Elasticity does not lead back from everywhere: an everted wall, for example, rests in some other shape, and a wall
// that bursts has no equilibrium. What loads hold is left alone.
bool ImplicitStep::lost() const {
  const StepperMemory& memory = state_.solver;
  if (memory.steps == 0 ||
      memory.elastic_energy > limits_.unheldEnergy()) {  // which has that of the foundation as well
    const double energy = stepper_.elasticEnergy(motionOf(), *scratch_.stepper);
    if (energy > limits_.unheldEnergy() && !heldByGas()) return true;
  }
  if (memory.steps % kCheckEvery != 0) return false;
  const double volume = lumenVolume(model_.organ.surface, state_.x, state_.y, state_.z);
  return volume < 0 || (model_.scene.gas && limits_.bursts(volume, state_.pressure, context_.insufflator_on));
}

// Whether the gas bears most of the wall's tension. By the virial theorem, forces in balance have opposite sums of
// force times position: 3 p V of the gas. The wall's gradient is that of the last elasticEnergy().
bool ImplicitStep::heldByGas() const {
  if (!model_.scene.gas) return false;
  const std::vector<float>& gradient = scratch_.stepper->work;
  double tension = 0;
  for (int i = 0; i < model_.particle_count; ++i)
    tension += gradient[4 * i] * state_.x[i] + gradient[4 * i + 1] * state_.y[i] + gradient[4 * i + 2] * state_.z[i];
  const double volume = lumenVolume(model_.organ.surface, state_.x, state_.y, state_.z);
  return 3 * state_.pressure * volume > kHeldPart * tension && volume > 0;
}

// Straight towards the rest position and without forces: a lost state has no meaningful dynamics.
void ImplicitStep::recover() {
  state_.energy.correction_work -= mechanicalEnergy().total() + state_.energy.contact_energy;
  state_.energy.contact_energy = 0;
  StepperMemory fresh;
  fresh.steps = state_.solver.steps + 1;
  fresh.elastic_energy = -1;
  fresh.recovery_steps = state_.solver.recovery_steps - 1;
  state_.solver = fresh;
  for (std::size_t k = 0; k < 3; ++k) scratch_.start[k] = state_.*kMotionOf[k];
  const double part = 1 - math::exp(-kRecoveryRate * context_.step);
  for (int i = 0; i < model_.particle_count; ++i) {
    const Eigen::Vector3d& rest = model_.organ.surface.vertices[i];
    state_.x[i] += part * (rest.x() - state_.x[i]);
    state_.y[i] += part * (rest.y() - state_.y[i]);
    state_.z[i] += part * (rest.z() - state_.z[i]);
  }
  stopMotion(state_);
  if (motion_ != nullptr) recoverAround();
  for (const auto& block : scratch_.blocks) block->recover(context_);
  state_.energy.correction_work += mechanicalEnergy().total() + state_.energy.contact_energy;
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

// @returns false where the state became useless; the simulator then resets it
bool ImplicitStep::solve() {
  scratch_.terms.clear();
  for (std::size_t k = 0; k < kMotion; ++k) scratch_.start[k] = state_.*kMotionOf[k];
  for (const auto& block : scratch_.blocks) scratch_.terms.add(block->energyTerm(context_));
  contact_energy_ = state_.energy.contact_energy;
  scratch_.loads.extra = scratch_.terms.simplest();
  const StepOutcome outcome = limited_
                                  ? stepper_.stepAgain(motionOf(), scratch_.loads, state_.solver, *scratch_.stepper)
                                  : stepper_.step(motionOf(), scratch_.loads, state_.solver, *scratch_.stepper);
  report_.iterations = outcome.iterations;
  report_.evaluations = outcome.evaluations;
  report_.residual = outcome.residual;
  report_.arrived = outcome.arrived;
  report_.fallback = outcome.fallback;
  work_ = outcome.work;
  if (!outcome.finite) std::fill(state_.x.begin(), state_.x.end(), std::numeric_limits<double>::quiet_NaN());
  if (outcome.finite && context_.bend != nullptr) yieldTool();
  return outcome.finite;
}

// From here on the tool is where the forces of this step have brought it.
void ImplicitStep::yieldTool() {
  yielded_ = *motion_;
  report_.tool_displacement = expected_;
  for (int d = 0; d < kYieldDofs; ++d) report_.tool_displacement[d] += scratch_.loads.tool_yield.displacement[d];
  yielded_->displaceEnd(report_.tool_displacement);
  yielded_->linkPoses(1, scratch_.tool.end);
}

// Whatever the solve left, walls and tool end on their sides.
// @returns false where the tool cannot go as far as the solve has it, and has stopped
bool ImplicitStep::keepApart() {
  for (std::size_t k = 0; k < 6; ++k) scratch_.uncorrected[k] = state_.*kMotionOf[k];
  for (const auto& block : scratch_.blocks) block->correct(context_);
  return motion_ == nullptr || keepToolApart();
}

// The solve had the tool where it does not come to, and the wall out of its way there; where the tool stops, the same
// wall would run into it, and both would stand still for good. Solved again with the tool where it can go, the wall
// makes room for the next step.
void ImplicitStep::giveWay() {
  for (std::size_t k = 0; k < kMotion; ++k) state_.*kMotionOf[k] = scratch_.start[k];
  motion_ = &*limited_;
  context_.bend = nullptr;
  yielded_.reset();
  gather();
  begin();
}

void ImplicitStep::store() {
  correct();
  scratch_.touches.clear();
  for (const auto& block : scratch_.blocks) work_.extra -= block->store(context_, scratch_.loads, scratch_.touches);
  if (motion_ != nullptr) {
    const double tool_work = state_.energy.tool_work;
    reportTool();
    reportHand(state_.energy.tool_work - tool_work);
    reportImpedance();
  }
  account();
}

// Corrections are motions without forces: their work is the difference of the energies.
void ImplicitStep::correct() {
  std::array<std::vector<double>, 6>& before = scratch_.uncorrected;
  bool changed = false;
  for (std::size_t k = 0; k < 6; ++k) changed = changed || before[k] != state_.*kMotionOf[k];
  if (!changed) return;
  const Energies after = mechanicalEnergy();
  for (std::size_t k = 0; k < 6; ++k) before[k].swap(state_.*kMotionOf[k]);
  const Energies uncorrected = mechanicalEnergy();
  for (std::size_t k = 0; k < 6; ++k) before[k].swap(state_.*kMotionOf[k]);
  state_.energy.correction_work += after.total() - uncorrected.total();
  state_.solver.elastic_energy += (after.elastic + after.foundation) - (uncorrected.elastic + uncorrected.foundation);
}

// Kinetic, elastic, of foundation and weight.
Energies ImplicitStep::mechanicalEnergy() const {
  Energies parts = energiesBesideElastic(model_, state_);
  parts.elastic = stepper_.elasticEnergy(motionOf(), *scratch_.stepper);
  return parts;
}

// @returns false where it stops for the first time in the step
bool ImplicitStep::keepToolApart() {
  const SurfacePath path = pathOfStep();
  ToolMotion motion = yielded_ ? *yielded_ : *motion_;
  const ToolMotion wanted = motion;
  scratch_.held.clear();
  const double whole = wholeWeight(state_.grip);
  for (const GripPoint& point : state_.grip)
    if (point.weight >= whole) scratch_.held.push_back(point.particle);
  if (!limited_ && scratch_.guard->stop(scratch_.tool, motion, path, scratch_.held)) {
    limited_ = motion;
    noteStopped(wanted);
    return false;
  }
  const double free = limited_ ? scratch_.guard->keepApart(scratch_.tool, motion, path, scratch_.held) : 1;
  tool_stopped_ = limited_.has_value();
  state_.joints = motion.inputs(1);
  if (model_.scope_springs) report_.tool_displacement = motion.displacement(1);
  if (free < 1) stopWall(free);
  return true;
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

void ImplicitStep::reportTool() {
  const Eigen::Vector3d tip = scratch_.tool.end[model_.tip_link].translation();
  for (const ToolTouch& touch : scratch_.touches) {
    if (touch.kind == ToolTouch::Kind::Grip) report_.grip_force -= touch.force;
    if (touch.kind == ToolTouch::Kind::Contact) ++report_.contact_count;
    state_.energy.friction_loss += touch.force.dot(touch.motion) - touch.work;
    pushTool(-touch.force, touch.point, touch.motion, tip, report_, state_.energy);
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
    effort += pointJacobian(*model_.tool, scratch_.tool.middle, touch.link, touch.middle).transpose() * touch.force;
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
  if (scratch_.touches.empty() && scratch_.loads.contacts.empty()) return;
  findToolContactRows(model_, *motion_, stepper_, report_, scratch_);
  report_.tool_impedance = scratch_.impedance->update(
      state_.step, scratch_.tool_rows, {state_.x.data(), state_.y.data(), state_.z.data()},
      scratch_.stepper->last.volume_gradient, scratch_.loads.gas.stiffness, state_.impedance);
}

void ImplicitStep::account() {
  EnergyAccount& sum = state_.energy;
  sum.gas_work += work_.gas;
  sum.damping_loss += work_.mass_damping;
  sum.viscous_loss += work_.viscous;
  sum.numerical_loss += work_.numerical;
  sum.residual_work += work_.residual;
  // what walls in contact took from the tissue is stored or lost
  sum.contact_loss -= work_.extra + sum.contact_energy - contact_energy_;
}

void ImplicitStep::updateRest(Activity activity) {
  const bool rests = activity != Activity::Disturb && maxSpeedSquared(state_) < kRestSpeed * kRestSpeed;
  state_.solver.rest_steps = rests ? state_.solver.rest_steps + 1 : 0;
  if (state_.solver.rest_steps >= kRestSteps) stopMotion(state_);
}

MotionView ImplicitStep::motionOf() const {
  return {{state_.x.data(), state_.y.data(), state_.z.data()},
          {state_.vx.data(), state_.vy.data(), state_.vz.data()},
          {state_.ax.data(), state_.ay.data(), state_.az.data()}};
}

}  // namespace vibe
