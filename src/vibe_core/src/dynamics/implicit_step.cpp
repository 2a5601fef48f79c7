#include "dynamics/implicit_step.hpp"

#include <algorithm>
#include <limits>

#include "solver/contact_bound.hpp"
#include "solver/step_solve.hpp"
#include "solver/stepper_workspace.hpp"
#include "solver/time_scheme.hpp"
#include "vibe_core/model/model.hpp"
#include "vibe_core/solver/step_policy.hpp"

namespace vibe {

ImplicitStep::ImplicitStep(const Model& model, const ImplicitStepper& stepper, const LossLimits& limits,
                           const ToolMotion* motion, bool insufflator_on, State& state, ImplicitWorkspace& scratch,
                           StepReport& report)
    : model_(model),
      stepper_(stepper),
      state_(state),
      report_(report),
      scratch_(scratch),
      watch_(model, stepper, limits, state, scratch),
      context_{model, state, model.scene.step_period, motion != nullptr ? &scratch.tool : nullptr, insufflator_on} {
  if (motion != nullptr) tool_.emplace(model, *motion, state, scratch, report);
  context_.pool = scratch.stepper->pool;
  const bool fallback = stepper.settings().backward_euler || state.solver.backward_euler_steps > 0;
  const TimeScheme& scheme = stepper.plan().schemeOf(fallback);
  context_.when = scheme.part() - stepPolicy().earlier_normals;
}

void ImplicitStep::run() {
  const Activity activity = gather();
  if (watch_.isAsleep(activity)) return report_.ways.count(StepWay::Asleep);
  begin();
  if (watch_.beginRecovery(context_.insufflator_on)) report_.put_back = true;
  if (watch_.isRecovering()) return recover();
  for (Attempt attempt = Attempt::First;;) {
    const AttemptResult result = tryStep(attempt);
    if (result == AttemptResult::Unusable) return;
    if (result == AttemptResult::Accepted) break;
    attempt = startAgain(result);
  }
  store();
  watch_.countRest(activity);
}

// @returns the most active of the blocks' answers
Activity ImplicitStep::gather() {
  const InStage stage(scratch_.stages, StepStage::Loads);
  scratch_.loads.clear();
  if (tool_) {
    scratch_.loads.held_still = tool_->holds();
    tool_->addSprings();
    context_.bend = tool_->bend();
  }
  Activity most = Activity::Sleep;
  for (const auto& block : scratch_.blocks) most = std::max(most, block->prepare(context_, scratch_.loads));
  scratch_.stepper->contract(scratch_.loads.contraction);
  return most;
}

void ImplicitStep::begin() {
  for (const auto& block : scratch_.blocks) block->begin(context_, scratch_.loads);
}

AttemptResult ImplicitStep::tryStep(Attempt attempt) {
  prepareSolve();
  if (const std::optional<AttemptResult> failed = solve(attempt)) return *failed;
  return separate(attempt) ? AttemptResult::Accepted : AttemptResult::LimitTool;
}

// Back to the state before the step, with what the attempt has taught.
Attempt ImplicitStep::startAgain(AttemptResult failed) {
  const bool limit = failed == AttemptResult::LimitTool;
  if (limit) {
    report_.ways.count(StepWay::ToolLimited);
    tool_->limit();
  } else {
    tool_->reaim(follow_);
  }
  for (std::size_t k = 0; k < kMotion; ++k) state_.*kMotionOf[k] = scratch_.start[k];
  gather();
  begin();
  return limit ? Attempt::ToolLimited : Attempt::ToolReaimed;
}

void ImplicitStep::prepareSolve() {
  scratch_.terms.clear();
  for (std::size_t k = 0; k < kMotion; ++k) scratch_.start[k] = state_.*kMotionOf[k];
  {
    const InStage stage(scratch_.stages, StepStage::Walls);
    for (const auto& block : scratch_.blocks) scratch_.terms.add(block->energyTerm(context_));
  }
  contact_energy_ = state_.energy.contact_energy;
  scratch_.loads.extra = scratch_.terms.simplest();
}

// Whether the tool misses where it was expected is asked twice in the first attempt: after the first direction, when
// another attempt costs little, and after the solve, which knows better. Steps with backward Euler are not tried again:
// they follow on one that failed, and their forces are no guide.
// @returns empty where the tissue has moved and the tool is where it was expected
std::optional<AttemptResult> ImplicitStep::solve(Attempt attempt) {
  StepperWorkspace& scratch = *scratch_.stepper;
  const bool first = attempt == Attempt::First;
  if (first)
    stepper_.begin(motionOf(state_), scratch_.loads, state_.solver, scratch);
  else
    stepper_.beginAgain(state_.solver, scratch);
  StepSolve solve(stepper_.plan(), motionOf(state_), scratch_.loads, state_.solver, scratch);
  solve.foresee();
  // another attempt costs little now
  if (first && tool_ && state_.solver.backward_euler_steps == 0 && tool_->misses()) {
    report_.evaluations += solve.abandon();
    report_.ways.count(StepWay::ToolReaimedEarly);
    follow_ = stepPolicy().aim_foreseen;
    return AttemptResult::ReaimTool;
  }
  // and more now, but the forces are those of the step
  const StepOutcome outcome = solve.finish();
  take(outcome);
  if (!outcome.finite) return AttemptResult::Unusable;
  if (first && tool_ && outcome.arrived && !outcome.fallback && tool_->misses()) {
    report_.ways.count(StepWay::ToolReaimed);
    follow_ = stepPolicy().aim_solved;
    return AttemptResult::ReaimTool;
  }
  return {};
}

void ImplicitStep::take(const StepOutcome& outcome) {
  report_.evaluations += outcome.evaluations;
  ++report_.solves;
  report_.iterations = outcome.iterations;
  report_.rows = scratch_.stepper->system.rows.count();
  report_.limited = static_cast<int>(std::max(scratch_.loads.contacts.size(), kMaxWithFriction) - kMaxWithFriction);
  report_.wall_pairs = scratch_.terms.pairCount();
  report_.residual = outcome.residual;
  report_.arrived = outcome.arrived;
  report_.fallback = outcome.fallback;
  report_.ways.add(outcome.ways);
  work_ = outcome.work;
  if (!outcome.finite) {
    report_.ways.count(StepWay::NotFinite);
    std::fill(state_.x.begin(), state_.x.end(), std::numeric_limits<double>::quiet_NaN());
  } else if (tool_) {
    tool_->yield();
  }
}

// Whatever the solve left, walls and tool end on their sides.
// @returns false where the tool cannot go as far as the solve has it, and has stopped
bool ImplicitStep::separate(Attempt attempt) {
  const InStage stage(scratch_.stages, StepStage::Paths);
  for (std::size_t k = 0; k < 6; ++k) scratch_.uncorrected[k] = state_.*kMotionOf[k];
  const bool may_stop = tool_ && attempt != Attempt::ToolLimited;
  // before the walls, which the next attempt moves elsewhere
  if (may_stop && tool_->isStopped()) return false;
  for (const auto& block : scratch_.blocks) block->correct(context_);
  if (may_stop && isCorrected() && tool_->isStopped()) return false;
  const double free = tool_ ? tool_->separate() : 1;
  if (free < 1) stopWall(free);
  return true;
}

bool ImplicitStep::isCorrected() const {
  for (std::size_t k = 0; k < 6; ++k)
    if (scratch_.uncorrected[k] != state_.*kMotionOf[k]) return true;
  return false;
}

// Straight paths of all nodes have been found free of crossings among each other, so they are at any common part of the
// paths as well.
void ImplicitStep::stopWall(double part) {
  report_.ways.count(StepWay::WallStopped);
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

void ImplicitStep::recover() {
  report_.ways.count(StepWay::Recovery);
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
  state_.hold = {};
  watch_.leadToRest();
  if (tool_) tool_->recoverAround();
  for (const auto& block : scratch_.blocks) block->recover(context_);
  state_.energy.correction_work += mechanicalEnergy().total() + state_.energy.contact_energy;
}

void ImplicitStep::store() {
  stepper_.end(report_.arrived, state_.solver);
  accountCorrections();
  scratch_.touches.clear();
  {
    const InStage stage(scratch_.stages, StepStage::Walls);
    for (const auto& block : scratch_.blocks) work_.extra -= block->store(context_, scratch_.loads, scratch_.touches);
  }
  if (tool_) tool_->report(stepper_);
  accountWorks();
}

// Corrections are motions without forces: their work is the difference of the energies.
void ImplicitStep::accountCorrections() {
  if (!isCorrected()) return watch_.countJam(0, 0);
  std::array<std::vector<double>, 6>& before = scratch_.uncorrected;
  const Energies after = mechanicalEnergy();
  for (std::size_t k = 0; k < 6; ++k) before[k].swap(state_.*kMotionOf[k]);
  const Energies uncorrected = mechanicalEnergy();
  for (std::size_t k = 0; k < 6; ++k) before[k].swap(state_.*kMotionOf[k]);
  state_.energy.correction_work += after.total() - uncorrected.total();
  watch_.countJam(after.total() - uncorrected.total(), after.elastic);
  state_.solver.elastic_energy += (after.elastic + after.foundation) - (uncorrected.elastic + uncorrected.foundation);
}

// Kinetic, elastic, of foundation and weight.
Energies ImplicitStep::mechanicalEnergy() const {
  Energies parts = energiesBesideElastic(model_, state_);
  parts.elastic = stepper_.elastic(motionOf(state_), *scratch_.stepper).energy;
  return parts;
}

void ImplicitStep::accountWorks() {
  EnergyAccount& sum = state_.energy;
  sum.gas_work += work_.gas;
  sum.damping_loss += work_.mass_damping;
  sum.viscous_loss += work_.viscous;
  sum.numerical_loss += work_.numerical;
  sum.residual_work += work_.residual;
  // what walls in contact took from the tissue is stored or lost
  sum.contact_loss -= work_.extra + sum.contact_energy - contact_energy_;
}

}  // namespace vibe
