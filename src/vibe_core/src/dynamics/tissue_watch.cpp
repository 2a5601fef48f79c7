#include "dynamics/tissue_watch.hpp"

#include <algorithm>
#include <cmath>

#include "arithmetic/elementary.hpp"
#include "geometry/surface_operators.hpp"
#include "model/step_accounts.hpp"
#include "vibe_core/model/accounting.hpp"
#include "vibe_core/model/model.hpp"
#include "vibe_core/solver/step_policy.hpp"

namespace vibe {

bool TissueWatch::isAsleep(Activity activity) const {
  const StepPolicy& policy = stepPolicy();
  return activity == Activity::Sleep && state_.solver.rest_steps >= policy.rest_steps &&
         state_.step % policy.wake_every != 0;
}

bool TissueWatch::beginRecovery(bool insufflator_on) {
  if (isRecovering() || !(isLost(insufflator_on) || isJammed())) return false;
  const double steps = stepPolicy().recovery_time / model_.scene.step_period;
  state_.solver.recovery_steps = std::max(1, static_cast<int>(std::lround(steps)));
  return true;
}

// Elasticity does not lead back from everywhere: an everted wall, for example, rests in some other shape, and a wall
// that bursts has no equilibrium. What loads hold is left alone.
bool TissueWatch::isLost(bool insufflator_on) const {
  const StepperMemory& memory = state_.solver;
  // the memory's energy has that of the foundation as well, so that it may only ask for the wall's own
  if (memory.steps == 0 || memory.elastic_energy > limits_.unheldEnergy()) {
    const ImplicitStepper::Elastic elastic = stepper_.elastic(motionOf(state_), *scratch_.stepper);
    if (elastic.energy > limits_.unheldEnergy() && !isHeldByGas(elastic.gradient)) return true;
  }
  if (memory.steps % stepPolicy().check_every != 0) return false;
  const double volume = lumenVolume(model_.organ.surface, state_.x, state_.y, state_.z);
  return volume < 0 || (model_.scene.gas && limits_.bursts(volume, state_.pressure, insufflator_on));
}

// Loops of a coarse wall may catch in each other. Their forces then lead through each other, for good.
bool TissueWatch::isJammed() const {
  return state_.solver.jammed_steps * model_.scene.step_period >= stepPolicy().jammed_time;
}

void TissueWatch::countJam(double given, double held) {
  int& steps = state_.solver.jammed_steps;
  const bool jams = given > stepPolicy().jammed_rate * model_.scene.step_period * held;
  steps = jams ? steps + 1 : std::max(0, steps - 1);
}

// Whether the gas bears most of the wall's tension. By the virial theorem, forces in balance have opposite sums of
// force times position: 3 p V of the gas.
bool TissueWatch::isHeldByGas(const std::vector<float>& elastic_gradient) const {
  if (!model_.scene.gas) return false;
  double tension = 0;
  for (int i = 0; i < model_.particle_count; ++i)
    tension += elastic_gradient[4 * i] * state_.x[i] + elastic_gradient[4 * i + 1] * state_.y[i] +
               elastic_gradient[4 * i + 2] * state_.z[i];
  const double volume = lumenVolume(model_.organ.surface, state_.x, state_.y, state_.z);
  const std::optional<RelaxationScene>& relaxation = model_.scene.tissue.relaxation;
  const double kept = relaxation ? 1 - relaxingShare(*relaxation) : 1;  // of the tension, at least
  return 3 * state_.pressure * volume > stepPolicy().held_part * kept * tension && volume > 0;
}

void TissueWatch::leadToRest() {
  for (std::size_t k = 0; k < 3; ++k) scratch_.start[k] = state_.*kMotionOf[k];
  const double part = 1 - math::exp(-stepPolicy().recovery_rate * model_.scene.step_period);
  for (int i = 0; i < model_.particle_count; ++i) {
    const Eigen::Vector3d& rest = model_.organ.surface.vertices[i];
    state_.x[i] += part * (rest.x() - state_.x[i]);
    state_.y[i] += part * (rest.y() - state_.y[i]);
    state_.z[i] += part * (rest.z() - state_.z[i]);
  }
  stopMotion(state_);
}

void TissueWatch::countRest(Activity activity) {
  const StepPolicy& policy = stepPolicy();
  const bool rests = activity != Activity::Disturb && maxSpeedSquared(state_) < policy.rest_speed * policy.rest_speed;
  state_.solver.rest_steps = rests ? state_.solver.rest_steps + 1 : 0;
  if (state_.solver.rest_steps >= policy.rest_steps) stopMotion(state_);
}

void stopMotion(State& state) {
  for (std::size_t k = 3; k < kMotion; ++k) std::fill((state.*kMotionOf[k]).begin(), (state.*kMotionOf[k]).end(), 0.0);
}

SurfacePath pathOfStep(const ImplicitWorkspace& scratch, const State& state) {
  SurfacePath path;
  for (std::size_t k = 0; k < 3; ++k) path.from[k] = scratch.start[k].data(), path.to[k] = (state.*kMotionOf[k]).data();
  return path;
}

}  // namespace vibe
