#include "solver/step_solve.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "solver/contact_bound.hpp"
#include "solver/step_rows.hpp"
#include "solver/step_work.hpp"
#include "vibe_core/solver/step_policy.hpp"

namespace vibe {

using From = Continuation::From;

StepSolve::StepSolve(const StepPlan& plan, const MotionView& motion, BodyLoads& loads, StepperMemory& memory,
                     StepperWorkspace& scratch)
    : plan_(plan),
      motion_(motion),
      loads_(loads),
      memory_(memory),
      scratch_(scratch),
      at_(scratch.iterate),
      system_(scratch.system),
      continuation_(scratch.continuation),
      fallback_(plan.settings.backward_euler || memory.backward_euler_steps > 0),
      scheme_(plan.schemeOf(fallback_)),
      potential_(plan.body, loads, scheme_.inertia, scratch, scheme_.part()),
      newton_(plan.body, potential_, loads, scratch,
              std::min(plan.safe_length, stepPolicy().usual_growth * memory.usual_length), evaluationsLeft()) {}

void StepSolve::foresee() {
  const double foreseen = continuation_.from == From::Abandoned ? continuation_.foreseen : guess();
  buildRows(loads_, motion_, system_);
  setStepTargets(loads_, motion_, scheme_, memory_.couplings, at_.z, system_);
  newton_.takeRows();
  newton_.judgeBy(foreseen);
  guessed_ = continuation_.from != From::Solution && (foreseen > 0 || plan_.extrapolates(fallback_));
  evaluateStart();
  {
    const InStage stage(scratch_.stages, StepStage::Factor);
    system_.schur.setRows(system_.rows, *scratch_.factors.current, scratch_.factors.columns);
  }
  newton_.setGas(foreseenVolume());
  if (guessed_ && newton_.referenceLength() > plan_.safe_length) doubtDirection();
  chooseContacts();
  newton_.aim();
  if (loads_.driven && continuation_.from != From::Solution) judgeDriven();
  storeToolForces(system_, loads_);
}

// A guess with far more energy may be tangled and lead to a tangled minimum: then start from the present positions.
void StepSolve::evaluateStart() {
  continuation_.from == From::Abandoned ? newton_.start(continuation_.value) : newton_.start();
  if (guessed_ && !(at_.last.elastic_value <= stepPolicy().guess_growth * memory_.elastic_energy)) {
    ways_.count(StepWay::GuessTangled);
    startFromHere();
  }
  if (continuation_.from != From::Solution) at_.first = at_.last;
}

// A motion that goes on is known but for a part of it. Where the first direction takes most of the guess back,
// something has met the body, and the guess is on the wrong side of that.
void StepSolve::doubtDirection() {
  newton_.aim();
  if (newton_.directionLength() < stepPolicy().misled_part * newton_.referenceLength()) return;
  ways_.count(StepWay::GuessMisled);
  startFromHere();
  at_.first = at_.last;
  newton_.setGas(foreseenVolume());
}

// The first direction is what a driven motion has changed by. Where that is short, what it leaves is far less than the
// next step changes by, and it is judged as a first direction from the present positions.
void StepSolve::judgeDriven() {
  change_ = newton_.directionLength();
  goes_on_ = !loads_.held_still && change_ < newton_.safeLength();
  if (goes_on_)
    newton_.judgeBy(0);
  else if (newton_.referenceLength() > 0)
    newton_.judgeBy(std::max(newton_.referenceLength(), change_));  // the way foreseen may be almost nothing
}

// Which contacts will push is known only after a direction was found.
void StepSolve::chooseContacts() {
  if (system_.rows.counted == system_.rows.contacts.size()) return;
  for (int n = 0; n < stepPolicy().contact_exchanges && exchangeContacts(newton_.foreseen(), system_); ++n) {
    ways_.count(StepWay::ContactsExchanged);
    setTargetsOfStep(loads_, motion_, scheme_, system_);
    system_.schur.setRows(system_.rows, *scratch_.factors.current, scratch_.factors.columns);
    newton_.takeRows();
  }
}

int StepSolve::abandon() {
  continuation_.from = newton_.referenceLength() > 0 ? From::Abandoned : From::Guess;
  continuation_.evaluations += newton_.evaluations();
  continuation_.value = newton_.value();
  continuation_.foreseen = newton_.referenceLength();
  continuation_.motion_length = 0;
  return newton_.evaluations();
}

StepOutcome StepSolve::finish() {
  StepOutcome outcome;
  outcome.fallback = fallback_;
  iterate(outcome);
  outcome.finite = std::isfinite(outcome.last_move) && std::isfinite(newton_.value());
  continuation_.motion_length = outcome.arrived && !fallback_ ? newton_.referenceLength() : 0;
  scratch_.gas_stiffness = potential_.gas().stiffness(at_.last.volume);
  if (fallback_) ways_.count(StepWay::BackwardEuler);
  if (!outcome.arrived) ways_.count(StepWay::NotArrived);
  outcome.ways = ways_;
  outcome.ways.add(newton_.ways());
  continuation_.from = From::Guess;  // an abandoned solve has been gone on with
  if (!outcome.finite) return outcome;
  storeForces(system_, scheme_.z_gain / scheme_.x_gain, loads_);
  storeGas(scratch_, loads_.gas);
  outcome.work = finishMotion(plan_.body, scheme_, motion_, loads_, !outcome.arrived, scratch_);
  correctStored(outcome);
  return outcome;
}

// Iterations go on until they contract: otherwise stiff motions would grow from step to step. Those of a tool that is
// held go on until they arrive, and each but the last one is evaluated.
void StepSolve::iterate(StepOutcome& outcome) {
  const StepPolicy& policy = stepPolicy();
  const double longest = fallback_ ? policy.fallback_max_move * plan_.size : std::numeric_limits<double>::max();
  const int usual = goes_on_ ? 1 : plan_.settings.iterations;
  const double tolerance = loads_.held_still ? policy.hold_tolerance : plan_.settings.tolerance;
  bool done = false;
  while (!(done && !loads_.held_still) && !outcome.converged && !newton_.exhausted() &&
         std::isfinite(outcome.last_move) && (!newton_.failed() || newton_.startAgain())) {
    newton_.aim();
    const bool tiny = newton_.directionLength() < std::max(tolerance, newton_.resolution());
    outcome.last_move = newton_.iterate(longest, !tiny && (loads_.held_still || outcome.iterations + 1 < usual));
    // what a tool holds goes where the tool goes, and the iterations that remain find the energy again
    if (++outcome.iterations == policy.satisfy_after && !newton_.exhausted() && newton_.satisfyConstraints()) continue;
    done = outcome.iterations >= usual && newton_.contracts();
    outcome.converged = tiny;
  }
  judgeEnd(done, outcome);
}

void StepSolve::judgeEnd(bool done, StepOutcome& outcome) {
  const StepPolicy& policy = stepPolicy();
  const double first_length = newton_.referenceLength();
  if (continuation_.from != From::Solution)
    memory_.usual_length += policy.usual_share * ((loads_.driven ? change_ : first_length) - memory_.usual_length);
  // a search that failed may have failed by rounding only: then less may be left for the step to count as arrived
  const double enough = newton_.failed() ? std::max(policy.nearly_arrived * first_length,
                                                    policy.position_roundings * newton_.resolution())
                                         : policy.arrived * first_length;
  const double usually_enough = loads_.held_still ? plan_.settings.tolerance : 0;
  outcome.arrived = outcome.converged || done || newton_.directionLength() < std::max(enough, usually_enough);
  outcome.residual = std::max({newton_.residual(), system_.schur.violation(), depthLeftOut(at_.z, system_)});
  outcome.evaluations = newton_.evaluations();
  continuation_.evaluations += outcome.evaluations;
  outcome.solves = newton_.solves();
}

// The first evaluation of a step tells the energy at its start. Where it differs from what the last step has foreseen,
// the scheme has lost the difference in the last step. What a constant stress takes in the step is still in what is
// foreseen.
void StepSolve::correctStored(StepOutcome& outcome) {
  StepWork& work = outcome.work;
  const double start = at_.first.elastic_value + (at_.first.stress_work - loads_.stress_work) - work.to_first;
  if (memory_.elastic_energy >= 0 && memory_.steps > 1) work.numerical -= start - memory_.elastic_energy;
  const double foreseen = start + work.stored;
  memory_.elastic_energy = std::max(0.0, foreseen);  // far from the forces' linear range it may be negative
  work.numerical -= memory_.elastic_energy - foreseen;
}

// @returns the length of the motion that is foreseen [m]; 0: none is
double StepSolve::guess() {
  const bool from_hat = plan_.extrapolates(fallback_), from_solution = continuation_.from == From::Solution;
  for (int i = 0; i < plan_.body.nodeCount(); ++i)
    for (int k = 0; k < 3; ++k) {
      const double x = motion_.x[k][i];
      const double hat = plan_.body.fixed[i] != 0 ? x : scheme_.hat_z(x, motion_.v[k][i], motion_.a[k][i]);
      at_.z_hat[4 * i + k] = hat;
      if (!from_solution) at_.z[4 * i + k] = from_hat ? hat : x;
    }
  if (from_solution) return continuation_.motion_length;
  if (from_hat || fallback_) return 0;
  if (!plan_.free) return predict();
  moveRigidly(plan_.body, motion_, scheme_, at_.z);
  return 0;
}

// A large motion goes on with its velocity, and the step has to find only what changes it. The velocity has the error
// that the last step has left, which its iterations have brought below a hundredth of such a motion. Of a small one it
// may be all, and would grow from step to step. A driven motion, which is small, goes on with its mean velocity over
// two steps: errors that alternate cancel in it, and others fade as long as the iterations contract.
double StepSolve::predict() {
  const ElasticBody& body = plan_.body;
  const double ahead = scheme_.part() * scheme_.h;
  double fastest2 = 0;
  for (int i = 0; i < body.nodeCount(); ++i) {
    double speed2 = 0;
    for (int k = 0; k < 3 && body.fixed[i] == 0; ++k) speed2 += motion_.v[k][i] * motion_.v[k][i];
    fastest2 = std::max(fastest2, speed2);
  }
  const double length = ahead * std::sqrt(fastest2), back = loads_.driven ? scheme_.h : 0;
  if (!(length > plan_.safe_length || loads_.driven)) return 0;
  for (int i = 0; i < body.nodeCount(); ++i)
    for (int k = 0; k < 3 && body.fixed[i] == 0; ++k)
      at_.z[4 * i + k] += ahead * (motion_.v[k][i] - back * motion_.a[k][i]);
  return length;
}

void StepSolve::startFromHere() {
  toPresent(motion_, plan_.body.nodeCount(), at_.z);
  newton_.start();
  newton_.judgeBy(0);
}

// Where the forces of the step act, if the nodes keep their velocities. It selects the stiffness of an insufflator,
// which only determines the rate of convergence.
double StepSolve::foreseenVolume() const {
  const Evaluation& here = at_.last;
  if (loads_.gas.control != GasLoad::Control::Regulated) return here.volume;
  double rate = 0;
  for (int k = 0; k < 3; ++k) {
    const float* const gradient = here.volume_gradient.data() + k;
    for (std::size_t i = 0; 4 * i < here.volume_gradient.size(); ++i)
      rate += static_cast<double>(gradient[4 * i]) * motion_.v[k][i];
  }
  return here.volume + scheme_.part() * scheme_.h * rate;
}

// What the solves of a step may take together leaves each of them enough for its least number of iterations.
int StepSolve::evaluationsLeft() const {
  const int iterations = plan_.settings.iterations, usual = iterations + kSpareEvaluations;
  return std::clamp(2 * usual - continuation_.evaluations, iterations + stepPolicy().least_spare,
                    fallback_ ? iterations + kSpareInFallback : usual);
}

void toPresent(const MotionView& motion, int nodes, std::vector<double>& z) {
  for (int i = 0; i < nodes; ++i)
    for (int k = 0; k < 3; ++k) z[4 * i + k] = motion.x[k][i];
}

void storeGas(const StepperWorkspace& scratch, GasLoad& gas) {
  gas.volume = scratch.iterate.last.volume;
  gas.pressure = scratch.iterate.last.pressure;
  gas.stiffness = scratch.gas_stiffness;
}

}  // namespace vibe
