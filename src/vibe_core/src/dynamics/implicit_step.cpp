#include "dynamics/implicit_solver.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "arithmetic/elementary.hpp"
#include "geometry/surface_operators.hpp"
#include "model/step_accounts.hpp"
#include "solver/stepper_workspace.hpp"
#include "solver/time_scheme.hpp"
#include "tool/tool_motion.hpp"
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
// Steps between checks for an organ that is inside out. Design choice: the check costs a pass over all triangles.
constexpr int kCheckEvery = 10;

// Walls are jammed where the guard against crossings takes back what the wall's forces do: rate at which it gives
// energy back, over the energy that the wall holds. Design choice: a fold that is drawn through its own loops has 40 to
// 60, one that is pressed together hardly any [1/s].
constexpr double kJammedRate = 6;
// Time for which they are until they are led back to rest. Design choice: folds that slip past each other are free
// within some steps [s].
constexpr double kJammedTime = 1;

// Share of the wall's tension that the gas has to bear for a state to count as held by it. Design choice: half; the
// rest is motion and what else pulls.
constexpr double kHeldPart = 0.5;

// How much earlier than the forces of the step the normals of tool contacts are taken, in steps. Design choice:
// vertices that come into contact within a step drive a tip that slides by 0.2 % of its normal force at 60 Hz; with
// this it is braked by a tenth of that instead [1].
constexpr double kEarlier = 0.05;

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
      context_{model, state, model.scene.step_period, motion != nullptr ? &scratch.tool : nullptr, insufflator_on} {
  context_.pool = scratch.stepper->pool;
  StepSettings settings = stepper.settings();
  settings.backward_euler = settings.backward_euler || state.solver.fallback > 0;
  context_.when = TimeScheme(settings, 0, 0).part() - kEarlier;
}

void ImplicitStep::run() {
  const Activity activity = gather();
  if (asleep(activity)) return;
  begin();
  if (state_.solver.recovery_steps <= 0 && (lost() || jammed())) {
    report_.put_back = true;
    state_.solver.recovery_steps = std::max(1, static_cast<int>(std::lround(kRecoveryTime / context_.step)));
  }
  if (state_.solver.recovery_steps > 0) return recover();
  if (!solve()) return;
  if (refused_ || (report_.arrived && !report_.fallback && missesTool())) {
    expectAgain();
    if (!solve()) return;
  }
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
  const InStage stage(scratch_.stages, StepStage::Loads);
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

// Loops of a coarse wall may catch in each other. Their forces then lead through each other, for good.
bool ImplicitStep::jammed() const {
  return -state_.solver.recovery_steps * context_.step >= kJammedTime;
}

// @param given  by the guard in this step [J]
// @param held   by the wall after it [J]
void ImplicitStep::noteJam(double given, double held) {
  int& steps = state_.solver.recovery_steps;
  steps = given > kJammedRate * context_.step * held ? steps - 1 : std::min(0, steps + 1);
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
  const Energies lost = mechanicalEnergy();
  // no step will tell any more by how much the last one has foreseen its energy wrong
  if (state_.solver.elastic_energy >= 0)
    state_.energy.numerical_loss -= lost.elastic + lost.foundation - state_.solver.elastic_energy;
  state_.energy.correction_work -= lost.total() + state_.energy.contact_energy;
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

// @returns false where the state became useless; the simulator then resets it
bool ImplicitStep::solve() {
  scratch_.terms.clear();
  for (std::size_t k = 0; k < kMotion; ++k) scratch_.start[k] = state_.*kMotionOf[k];
  {
    const InStage stage(scratch_.stages, StepStage::Walls);
    for (const auto& block : scratch_.blocks) scratch_.terms.add(block->energyTerm(context_));
  }
  contact_energy_ = state_.energy.contact_energy;
  scratch_.loads.extra = scratch_.terms.simplest();
  const StepOutcome outcome = advance();
  report_.evaluations += outcome.evaluations;
  refused_ = outcome.refused;
  if (!refused_) note(outcome);
  return outcome.finite;
}

StepOutcome ImplicitStep::advance() {
  StepperWorkspace& scratch = *scratch_.stepper;
  if (limited_ || expected_again_) return stepper_.stepAgain(motionOf(), scratch_.loads, state_.solver, scratch);
  const auto accepts = [this] { return state_.solver.fallback > 0 || !missesTool(); };
  return stepper_.step(motionOf(), scratch_.loads, state_.solver, scratch, accepts);
}

void ImplicitStep::note(const StepOutcome& outcome) {
  ++report_.solves;
  report_.iterations = outcome.iterations;
  report_.rows = scratch_.stepper->rows.count();
  report_.limited = static_cast<int>(std::max(scratch_.loads.contacts.size(), kMaxWithFriction) - kMaxWithFriction);
  report_.wall_pairs = scratch_.terms.pairCount();
  report_.residual = outcome.residual;
  report_.arrived = outcome.arrived;
  report_.fallback = outcome.fallback;
  work_ = outcome.work;
  if (!outcome.finite) std::fill(state_.x.begin(), state_.x.end(), std::numeric_limits<double>::quiet_NaN());
  if (outcome.finite && context_.bend != nullptr) yieldTool();
}

// Whatever the solve left, walls and tool end on their sides.
// @returns false where the tool cannot go as far as the solve has it, and has stopped
bool ImplicitStep::keepApart() {
  const InStage stage(scratch_.stages, StepStage::Paths);
  for (std::size_t k = 0; k < 6; ++k) scratch_.uncorrected[k] = state_.*kMotionOf[k];
  const bool may_stop = motion_ != nullptr && !limited_;
  if (may_stop && stopsTool()) return false;  // before the walls, which the next solve moves elsewhere
  for (const auto& block : scratch_.blocks) block->correct(context_);
  if (may_stop && isCorrected() && stopsTool()) return false;
  if (motion_ != nullptr) keepToolApart();
  return true;
}

bool ImplicitStep::isCorrected() const {
  for (std::size_t k = 0; k < 6; ++k)
    if (scratch_.uncorrected[k] != state_.*kMotionOf[k]) return true;
  return false;
}

// The solve had the tool where it does not come to, and the wall out of its way there; where the tool stops, the same
// wall would run into it, and both would stand still for good. Solved again with the tool where it can go, the wall
// makes room for the next step.
void ImplicitStep::giveWay() {
  motion_ = &*limited_;
  context_.bend = nullptr;
  yielded_.reset();
  startAgain();
}

void ImplicitStep::startAgain() {
  for (std::size_t k = 0; k < kMotion; ++k) state_.*kMotionOf[k] = scratch_.start[k];
  gather();
  begin();
}

void ImplicitStep::store() {
  correct();
  scratch_.touches.clear();
  {
    const InStage stage(scratch_.stages, StepStage::Walls);
    for (const auto& block : scratch_.blocks) work_.extra -= block->store(context_, scratch_.loads, scratch_.touches);
  }
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
  if (!isCorrected()) return noteJam(0, 0);
  std::array<std::vector<double>, 6>& before = scratch_.uncorrected;
  const Energies after = mechanicalEnergy();
  for (std::size_t k = 0; k < 6; ++k) before[k].swap(state_.*kMotionOf[k]);
  const Energies uncorrected = mechanicalEnergy();
  for (std::size_t k = 0; k < 6; ++k) before[k].swap(state_.*kMotionOf[k]);
  state_.energy.correction_work += after.total() - uncorrected.total();
  noteJam(after.total() - uncorrected.total(), after.elastic);
  state_.solver.elastic_energy += (after.elastic + after.foundation) - (uncorrected.elastic + uncorrected.foundation);
}

// Kinetic, elastic, of foundation and weight.
Energies ImplicitStep::mechanicalEnergy() const {
  Energies parts = energiesBesideElastic(model_, state_);
  parts.elastic = stepper_.elasticEnergy(motionOf(), *scratch_.stepper);
  return parts;
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
