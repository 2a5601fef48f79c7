#include "dynamics/implicit_step.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "dynamics/tool_contact_rows.hpp"
#include "geometry/lumen.hpp"
#include "model/max_speed.hpp"
#include "model/tool_push.hpp"
#include "solver/stepper_scratch.hpp"

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

void stopMotion(State& state) {
  for (auto* v : {&state.vx, &state.vy, &state.vz, &state.ax, &state.ay, &state.az})
    std::fill(v->begin(), v->end(), 0.0);
}

}  // namespace

ImplicitStep::ImplicitStep(const Model& model, const ImplicitStepper& stepper, double absurd_energy,
                           const ToolMotion* motion, bool insufflator_on, State& state, ImplicitScratch& scratch,
                           StepReport& report)
    : model_(model),
      stepper_(stepper),
      absurd_energy_(absurd_energy),
      motion_(motion),
      state_(state),
      report_(report),
      scratch_(scratch),
      context_{model, state, model.scene.step_period, motion != nullptr ? &scratch.poses : nullptr, insufflator_on} {}

void ImplicitStep::run() {
  const Activity activity = gather();
  if (asleep(activity)) return;
  for (const auto& block : scratch_.blocks) block->begin(context_, scratch_.loads);
  if (state_.solver.recovery_steps == 0 && lost()) {
    report_.put_back = true;
    state_.solver.recovery_steps = std::max(1, static_cast<int>(std::lround(kRecoveryTime / context_.step)));
  }
  if (state_.solver.recovery_steps > 0) return recover();
  if (!solve()) return;
  store();
  updateRest(activity);
}

// @returns the most active of the blocks' answers
Activity ImplicitStep::gather() {
  if (motion_ != nullptr) {
    motion_->linkPoses(0, scratch_.poses.start);
    motion_->linkPoses(1, scratch_.poses.end);
  }
  scratch_.loads.clear();
  Activity most = Activity::Sleep;
  for (const auto& block : scratch_.blocks) most = std::max(most, block->prepare(context_, scratch_.loads));
  return most;
}

bool ImplicitStep::asleep(Activity activity) const {
  return activity == Activity::Sleep && state_.solver.rest_steps >= kRestSteps && state_.step % kWakeEvery != 0;
}

// Elasticity does not lead back from everywhere: an everted wall, for example, rests in some other shape.
bool ImplicitStep::lost() const {
  const StepperMemory& memory = state_.solver;
  const double energy =
      memory.steps == 0 ? stepper_.elasticEnergy(motionOf(), *scratch_.stepper) : memory.elastic_energy;
  if (energy > absurd_energy_) return true;
  return memory.steps % kCheckEvery == 0 && lumenVolume(model_.organ.surface, state_.x, state_.y, state_.z) < 0;
}

// Straight towards the rest position and without forces: a lost state has no meaningful dynamics.
void ImplicitStep::recover() {
  StepperMemory fresh;
  fresh.steps = state_.solver.steps + 1;
  fresh.recovery_steps = state_.solver.recovery_steps - 1;
  state_.solver = fresh;
  const double part = 1 - std::exp(-kRecoveryRate * context_.step);
  for (int i = 0; i < model_.particle_count; ++i) {
    const Eigen::Vector3d& rest = model_.organ.surface.vertices[i];
    state_.x[i] += part * (rest.x() - state_.x[i]);
    state_.y[i] += part * (rest.y() - state_.y[i]);
    state_.z[i] += part * (rest.z() - state_.z[i]);
  }
  stopMotion(state_);
  for (const auto& block : scratch_.blocks) block->recover(context_);
}

// @returns false where the state became useless; the simulator then resets it
bool ImplicitStep::solve() {
  scratch_.terms.clear();
  for (const auto& block : scratch_.blocks) scratch_.terms.add(block->energyTerm(context_));
  scratch_.loads.extra = scratch_.terms.simplest();
  const StepOutcome outcome = stepper_.step(motionOf(), scratch_.loads, state_.solver, *scratch_.stepper);
  report_.iterations = outcome.iterations;
  report_.evaluations = outcome.evaluations;
  report_.residual = outcome.residual;
  report_.arrived = outcome.arrived;
  report_.fallback = outcome.fallback;
  if (!outcome.finite) std::fill(state_.x.begin(), state_.x.end(), std::numeric_limits<double>::quiet_NaN());
  return outcome.finite;
}

void ImplicitStep::store() {
  for (const auto& block : scratch_.blocks) block->correct(context_);
  scratch_.touches.clear();
  for (const auto& block : scratch_.blocks) block->store(context_, scratch_.loads, scratch_.touches);
  if (motion_ != nullptr) {
    reportTool();
    reportImpedance();
  }
  accountDamping();
}

void ImplicitStep::reportTool() {
  const Eigen::Vector3d tip = scratch_.poses.end[model_.tip_link].translation();
  for (const ToolTouch& touch : scratch_.touches) {
    if (touch.kind == ToolTouch::Kind::Grip) report_.grip_force -= touch.force;
    if (touch.kind == ToolTouch::Kind::Contact) ++report_.contact_count;
    pushTool(-touch.force, touch.point, touch.motion, tip, report_, state_.energy);
  }
}

// Begins before anything is touched, because the factor that the impedance needs takes a while to make.
void ImplicitStep::reportImpedance() {
  if (scratch_.touches.empty() && scratch_.loads.contacts.empty()) return;
  findToolContactRows(model_, *motion_, stepper_, report_, scratch_);
  report_.tool_impedance =
      scratch_.impedance->update(state_.step, scratch_.tool_rows, {state_.x.data(), state_.y.data(), state_.z.data()},
                                 scratch_.stepper->volume_gradient, scratch_.loads.gas.stiffness, state_.impedance);
}

void ImplicitStep::accountDamping() {
  double kinetic = 0;
  for (int i = 0; i < model_.particle_count; ++i)
    if (model_.inverse_mass[i] > 0)
      kinetic += 0.5 * model_.mass[i] *
                 (state_.vx[i] * state_.vx[i] + state_.vy[i] * state_.vy[i] + state_.vz[i] * state_.vz[i]);
  state_.energy.damping_loss += 2 * kinetic * model_.scene.tissue.mass_damping * context_.step;
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
