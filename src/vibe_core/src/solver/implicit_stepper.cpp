#include "vibe_core/solver/implicit_stepper.hpp"

#include <algorithm>
#include <utility>

#include "solver/static_solve.hpp"
#include "solver/step_plan.hpp"
#include "solver/step_solve.hpp"
#include "solver/stepper_workspace.hpp"
#include "vibe_core/solver/step_policy.hpp"

namespace vibe {

BodyMotion::BodyMotion(const ElasticBody& body) {
  for (int k = 0; k < 3; ++k) {
    for (const Eigen::Vector3d& p : body.rest) x[k].push_back(p[k]);
    v[k].assign(body.rest.size(), 0);
    a[k].assign(body.rest.size(), 0);
  }
}

MotionView BodyMotion::view() {
  return {{x[0].data(), x[1].data(), x[2].data()},
          {v[0].data(), v[1].data(), v[2].data()},
          {a[0].data(), a[1].data(), a[2].data()}};
}

ImplicitStepper::ImplicitStepper(ElasticBody body, StepSettings settings, FactorStorage storage)
    : plan_(std::make_unique<const StepPlan>(std::move(body), settings, storage)) {}

ImplicitStepper::~ImplicitStepper() = default;

const ElasticBody& ImplicitStepper::body() const {
  return plan_->body;
}

const StepSettings& ImplicitStepper::settings() const {
  return plan_->settings;
}

std::shared_ptr<StepperWorkspace> ImplicitStepper::makeWorkspace() const {
  return std::make_shared<StepperWorkspace>(plan_->body.rest, plan_->factor_plan, plan_->storage, plan_->pattern,
                                            plan_->shelf);
}

std::shared_ptr<const Factor> ImplicitStepper::shareFactor(const StepperMemory& memory,
                                                           StepperWorkspace& scratch) const {
  return plan_->schedule.share(plan_->body, memory, scratch.factors, *scratch.pool);
}

void ImplicitStepper::refactor(const MotionView& motion, StepperMemory& memory) const {
  FactorSchedule::nameHere(plan_->body, motion, memory);
}

StepOutcome ImplicitStepper::step(MotionView motion, BodyLoads& loads, StepperMemory& memory,
                                  StepperWorkspace& scratch) const {
  scratch.contract(loads.contraction);
  begin(motion, loads, memory, scratch);
  StepSolve solve(*plan_, motion, loads, memory, scratch);
  solve.foresee();
  const StepOutcome outcome = solve.finish();
  end(outcome.arrived, memory);
  return outcome;
}

void ImplicitStepper::begin(const MotionView& motion, const BodyLoads& loads, StepperMemory& memory,
                            StepperWorkspace& scratch) const {
  {
    const InStage stage(scratch.stages, StepStage::Factor);
    plan_->schedule.advance(plan_->body, motion, loads, memory, scratch.factors);
    if (plan_->schedule.provide(plan_->body, loads, memory, scratch.factors, *scratch.pool))
      scratch.system.schur.reset(*scratch.factors.current);
  }
  ++memory.steps;
  scratch.continuation = Continuation();
  scratch.continuation.elastic_energy = memory.elastic_energy;
  scratch.continuation.usual_length = memory.usual_length;
}

void ImplicitStepper::beginAgain(StepperMemory& memory, StepperWorkspace& scratch) const {
  Continuation& from = scratch.continuation;
  const bool arrived = from.motion_length > 0 && !plan_->extrapolates(false);
  if (arrived) from.from = Continuation::From::Solution;
  // each solve is judged as if it were the first
  memory.elastic_energy = from.elastic_energy;
  if (!arrived) memory.usual_length = from.usual_length;
}

// What is left of a step that did not arrive has high frequencies, and a scheme of second order would hand it on.
void ImplicitStepper::end(bool arrived, StepperMemory& memory) const {
  int& steps = memory.backward_euler_steps;
  steps = arrived || settings().backward_euler ? std::max(0, steps - 1) : stepPolicy().fallback_steps;
}

StepOutcome ImplicitStepper::settle(MotionView motion, BodyLoads& loads, StepperWorkspace& scratch, double tolerance,
                                    int max_iterations) const {
  scratch.contract(loads.contraction);
  return StaticSolve(*plan_, loads, scratch).run(motion, tolerance, max_iterations);
}

ImplicitStepper::Elastic ImplicitStepper::elastic(const MotionView& motion, StepperWorkspace& scratch) const {
  const ElasticBody& body = plan_->body;
  std::vector<float>&displacement = scratch.iterate.last.displacement, &gradient = scratch.iterate.work;
  for (int i = 0; i < body.nodeCount(); ++i)
    for (int k = 0; k < 3; ++k) displacement[4 * i + k] = static_cast<float>(motion.x[k][i] - body.rest[i][k]);
  for (std::size_t i = 3; i < displacement.size(); i += 4) displacement[i] = static_cast<float>(-scratch.rest[i]);
  std::fill(gradient.begin(), gradient.end(), 0.0F);
  if (!scratch.shared.shares.empty())
    return {scratch.shared.evaluate(*body.shell, *scratch.pool, displacement.data(), gradient.data(), nullptr, nullptr),
            gradient};
  double energy = 0;
  for (int p = 0; p < body.elements->pieceCount(); ++p)
    energy += body.elements->evaluate(p, displacement.data(), gradient.data());
  return {energy, gradient};
}

}  // namespace vibe
