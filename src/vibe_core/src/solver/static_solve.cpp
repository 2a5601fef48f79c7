#include "solver/static_solve.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "solver/couplings.hpp"
#include "solver/quasi_newton.hpp"
#include "solver/step_rows.hpp"
#include "solver/step_solve.hpp"
#include "vibe_core/solver/step_policy.hpp"

namespace vibe {

StepOutcome StaticSolve::run(const MotionView& motion, double tolerance, int max_iterations) {
  const StepPolicy& policy = stepPolicy();
  FactorSlots& factors = scratch_.factors;
  if (factors.making) factors.making->finish();
  factors.current_id = factors.next_id = 0;
  // the factor is renewed at once, so that none is about anything that a step named
  toPresent(motion, plan_.body.nodeCount(), scratch_.iterate.z);
  buildRows(loads_, motion, scratch_.system);
  setEquilibriumTargets(loads_, scratch_.iterate.z, scratch_.system);
  Potential potential(plan_.body, loads_, 0, scratch_);
  QuasiNewton newton(plan_.body, potential, loads_, scratch_);
  newton.takeRows();
  StepOutcome outcome;
  double before = std::numeric_limits<double>::max();
  while (outcome.iterations < max_iterations && !outcome.converged && std::isfinite(outcome.last_move)) {
    // far from equilibrium the factor is soon old; near it, it may stay
    const bool slow = newton.directionLength() > policy.slow_contraction * before;
    before = newton.directionLength();
    if (outcome.iterations % policy.refactor_every == 0 || (slow && outcome.iterations % policy.refactor_slow == 0)) {
      refactor();
      newton.start();
      ++outcome.refactorisations;
    }
    // the gas is as stiff as at the last point: the iteration changes it where it must
    newton.setGas(scratch_.iterate.last.volume);
    outcome.last_move = newton.iterate(policy.fallback_max_move * plan_.size, true);
    ++outcome.iterations;
    outcome.converged = newton.directionLength() < std::max(tolerance, newton.resolution());
    if (newton.failed()) newton.start();
  }
  // a body that has run away is left as it was
  outcome.finite = std::isfinite(outcome.last_move);
  if (!outcome.finite) return outcome;
  storeForces(scratch_.system, 1, loads_);
  storeGas(scratch_, loads_.gas);
  placeAtRest(motion);
  return outcome;
}

void StaticSolve::refactor() {
  const std::vector<double>& z = scratch_.iterate.z;
  FactorSlots& factors = scratch_.factors;
  const std::size_t nodes = plan_.body.rest.size();
  std::vector<float> positions(3 * nodes);
  for (std::size_t i = 0; i < nodes; ++i)
    for (std::size_t k = 0; k < 3; ++k) positions[3 * i + k] = static_cast<float>(z[4 * i + k]);
  if (loads_.contraction != nullptr)
    positions.insert(positions.end(), loads_.contraction->begin(), loads_.contraction->end());
  std::vector<StiffnessCoupling> couplings;
  collectCouplings(loads_, z.data(), 1, couplings);
  factors.returnLent();
  // a squashed state may have no positive definite stiffness; rest has
  if (!factorAt(plan_.body, {positions, couplings}, 0, 1, factors.plan, factors.matrix, *factors.current,
                *scratch_.pool))
    factorAt(plan_.body, {{}, {}}, 0, 1, factors.plan, factors.matrix, *factors.current, *scratch_.pool);
  factors.columns.reset();
  factors.columns.setAttachments(*factors.current, loads_.attachments);
  scratch_.system.schur.reset(*factors.current);
  findMissingTurns(loads_, couplings, scratch_.system.rows);
  scratch_.system.schur.setRows(scratch_.system.rows, *factors.current, factors.columns);
}

void StaticSolve::placeAtRest(const MotionView& motion) const {
  for (int i = 0; i < plan_.body.nodeCount(); ++i)
    for (int k = 0; k < 3; ++k) {
      motion.x[k][i] = scratch_.iterate.z[4 * i + k];
      motion.v[k][i] = motion.a[k][i] = 0;
    }
}

}  // namespace vibe
