#include "vibe_core/solver/implicit_stepper.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "solver/couplings.hpp"
#include "solver/quasi_newton.hpp"
#include "solver/stepper_workspace.hpp"
#include "solver/time_scheme.hpp"
#include "sparse/factor_plan.hpp"

namespace vibe {

namespace {

// Stiffness of the factor over that of the body where a step has one iteration. Such a step is unstable where the true
// stiffness exceeds that of the factor: its error (1 - ratio) enters the acceleration. With two or more iterations it
// is unstable only beyond twice the stiffness of the factor (docs/computation.md, the time step) [1].
constexpr double kMarginOfOne = 2;
// Elastic energy of an extrapolated guess over that of the last step, above which the guess is dropped. Design choice:
// a guess along a smooth motion changes the energy by a few percent per step [1].
constexpr double kGuessGrowth = 2;
// First direction from the predicted positions over the predicted motion, above which the step starts from the present
// positions. Design choice: half; where the motion goes on as it was, it is a few hundredths to a third [1].
constexpr double kMisled = 0.5;
// Steps with backward Euler after a step that did not arrive. Design choice: three, in which backward Euler damps what
// made the step fail; more cost twice as many iterations each and take energy from folds that snap on.
constexpr int kFallbackSteps = 3;
// Evaluations of the last solve of a step beyond its iterations. Design choice: one for its start and one for a
// shorter move.
constexpr int kLeastSpare = 2;
// Times that contacts may take each other's rows before a step moves. Design choice: each costs a direction; what is
// then left out stops the step's motion.
constexpr int kExchanges = 3;
// Iterations after which the constraints are met exactly, whatever that costs in energy. Design choice: about half of
// what a step may take, so that as many iterations remain to reduce the energy again.
constexpr int kSatisfyConstraints = 5;
// Largest move of a fallback or static iteration over the size of the body. Design choice: about a fold of the wall of
// a stomach (1 cm in 20 cm), within which the linearization is still of some use [1].
constexpr double kFallbackMaxMove = 0.05;
// Strain that a last, unverified move may bring to the shortest edge. Design choice: elastic forces are linear up to
// strains of this order, so that such a move cannot raise the energy [1].
constexpr double kSafeStrain = 0.02;
// Length of a first move over its running mean, beyond which a short move is verified as well. Design choice: larger
// moves mean that something new acts [1].
constexpr double kUsualGrowth = 1.5;
// Weight of the last step in that running mean. Design choice: a memory of ten steps [1].
constexpr double kUsualShare = 0.1;
// Length of the last direction over the first, above which a step counts as not arrived. Design choice: a step that
// leaves half of its move has not found the equilibrium [1].
constexpr double kArrived = 0.5;
// The same where the last direction did not lower the energy: near the end that may be due to rounding. Design choice:
// what a step may leave anyway [1].
constexpr double kNearlyArrived = 0.1;
// The same over the rounding error of a position. Design choice: in some directions energies are less certain [1].
constexpr double kPositionRoundings = 10;
// Iterations of a static solve between two factors. Design choice: a factor costs about as much as ten iterations; six
// is the history that a new factor discards.
constexpr int kRefactorEvery = 6;
// The same where the iterations contract slowly.
constexpr int kRefactorSlow = 3;
// Length of a direction over the one before, above which a static solve counts as slow. Design choice: at this rate six
// iterations gain three decimals [1].
constexpr double kSlow = 0.3;

// between two nodes of one element [m]
double shortestDistance(const ElasticBody& body) {
  double shortest2 = std::numeric_limits<double>::max();
  for (const auto& [nodes, size] : body.elements->nodeGroups())
    for (std::size_t first = 0; first < nodes->size(); first += static_cast<std::size_t>(size))
      for (int a = 0; a < size; ++a)
        for (int b = 0; b < a; ++b) {
          const int p = (*nodes)[first + a], q = (*nodes)[first + b];
          if (p >= 0 && q >= 0 && p != q) shortest2 = std::min(shortest2, (body.rest[p] - body.rest[q]).squaredNorm());
        }
  return std::sqrt(shortest2);
}

// Where the forces of the step act, if the nodes keep their velocities. It selects the stiffness of an insufflator,
// which only determines the rate of convergence.
double foreseenVolume(const GasLoad& gas, const MotionView& motion, const TimeScheme& scheme,
                      const StepperWorkspace& scratch) {
  if (gas.control != GasLoad::Control::Regulated) return scratch.last.volume;
  double rate = 0;
  for (int k = 0; k < 3; ++k) {
    const float* const gradient = scratch.last.volume_gradient.data() + k;
    for (std::size_t i = 0; 4 * i < scratch.last.volume_gradient.size(); ++i)
      rate += static_cast<double>(gradient[4 * i]) * motion.v[k][i];
  }
  return scratch.last.volume + scheme.part() * scheme.h * rate;
}

// 0: the factor stays
int factorSteps(const StepSettings& settings, const FactorPlan& plan) {
  if (!(settings.refactor_interval > 0)) return 0;
  const double interval = std::max(settings.refactor_interval, plan.operations / settings.factor_rate);
  return std::max(1, static_cast<int>(std::lround(interval / settings.step)));
}

FactorSchedule scheduleOf(const StepSettings& settings, const TimeScheme& scheme, const FactorPlan& plan) {
  FactorSchedule schedule;
  schedule.inertia = scheme.inertia;
  schedule.gain = scheme.z_gain / scheme.x_gain;
  schedule.margin = settings.iterations == 1 && !settings.backward_euler ? kMarginOfOne : 1;
  schedule.steps = factorSteps(settings, plan);
  schedule.distance = settings.refactor_distance;
  return schedule;
}

StepSettings fallbackOf(StepSettings settings) {
  settings.backward_euler = true;
  return settings;
}

}  // namespace

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

struct ImplicitStepper::Plan {
  Plan(const ElasticBody& body, const StepSettings& settings, FactorStorage factor_storage)
      : pattern(std::make_shared<const BlockPattern>(blockPattern(body.nodeCount(), body.elements->nodeGroups()))),
        factor_plan(makeFactorPlan(*pattern)),
        scheme(settings, body.mass_damping, body.stiffness_damping),
        fallback_scheme(fallbackOf(settings), body.mass_damping, body.stiffness_damping),
        schedule(scheduleOf(settings, scheme, *factor_plan)),
        storage(factor_storage),
        free(body.foundation.empty() &&
             std::none_of(body.fixed.begin(), body.fixed.end(), [](char fixed) { return fixed != 0; })),
        safe_length(kSafeStrain * shortestDistance(body)) {
    for (const Eigen::Vector3d& p : body.rest) size = std::max(size, (p - body.rest[0]).norm());
  }

  std::shared_ptr<const BlockPattern> pattern;
  std::shared_ptr<const FactorPlan> factor_plan;
  TimeScheme scheme, fallback_scheme;
  FactorSchedule schedule;
  FactorStorage storage;
  std::shared_ptr<FactorShelf> shelf = std::make_shared<FactorShelf>();
  bool free;           // nothing holds the body
  double safe_length;  // of a move that is not verified [m]
  double size = 0;     // of the body [m]
};

ImplicitStepper::ImplicitStepper(ElasticBody body, StepSettings settings, FactorStorage storage)
    : body_(std::move(body)), settings_(settings), plan_(std::make_unique<Plan>(body_, settings_, storage)) {}

ImplicitStepper::~ImplicitStepper() = default;

std::shared_ptr<StepperWorkspace> ImplicitStepper::makeWorkspace() const {
  return std::make_shared<StepperWorkspace>(body_.rest, plan_->factor_plan, plan_->storage, plan_->pattern,
                                            plan_->shelf);
}

std::shared_ptr<const Factor> ImplicitStepper::shareFactor(const StepperMemory& memory,
                                                           StepperWorkspace& scratch) const {
  return plan_->schedule.share(body_, memory, scratch);
}

void ImplicitStepper::refactor(const MotionView& motion, StepperMemory& memory) const {
  FactorSchedule::nameHere(body_, motion, memory);
}

StepOutcome ImplicitStepper::step(MotionView motion, BodyLoads& loads, StepperMemory& memory, StepperWorkspace& scratch,
                                  const std::function<bool()>& accepts) const {
  {
    const InStage stage(scratch.stages, StepStage::Factor);
    plan_->schedule.advance(body_, motion, loads, memory, scratch);
    plan_->schedule.provide(body_, loads, memory, scratch);
  }
  ++memory.steps;
  scratch.solved = scratch.refused = false;
  scratch.spent = 0;
  scratch.elastic_energy = memory.elastic_energy;
  scratch.usual_length = memory.usual_length;
  return advance(motion, loads, memory, scratch, accepts);
}

StepOutcome ImplicitStepper::stepAgain(MotionView motion, BodyLoads& loads, StepperMemory& memory,
                                       StepperWorkspace& scratch) const {
  scratch.solved = scratch.motion_length > 0 && memory.fallback == 0 && !extrapolates(false);
  memory.elastic_energy = scratch.elastic_energy;
  if (!scratch.solved) memory.usual_length = scratch.usual_length;
  return advance(motion, loads, memory, scratch, {});
}

StepOutcome ImplicitStepper::advance(MotionView motion, BodyLoads& loads, StepperMemory& memory,
                                     StepperWorkspace& scratch, const std::function<bool()>& accepts) const {
  StepOutcome outcome;
  outcome.fallback = settings_.backward_euler || memory.fallback > 0;
  iterateStep(motion, loads, memory, scratch, accepts, outcome);
  if (outcome.refused) return outcome;
  if (memory.fallback > 0) --memory.fallback;
  if (!outcome.finite) return outcome;
  if (!outcome.arrived && !settings_.backward_euler) memory.fallback = kFallbackSteps;
  const TimeScheme& scheme = outcome.fallback ? plan_->fallback_scheme : plan_->scheme;
  storeForces(scratch, scheme.z_gain / scheme.x_gain, loads);
  outcome.work = finishMotion(body_, scheme, motion, loads, !outcome.arrived, scratch);
  correctStored(memory, scratch, outcome);
  return outcome;
}

// The first evaluation of a step tells the energy at its start. Where it differs from what the last step has foreseen,
// the scheme has lost the difference in the last step.
void ImplicitStepper::correctStored(StepperMemory& memory, const StepperWorkspace& scratch, StepOutcome& outcome) {
  StepWork& work = outcome.work;
  const double start = scratch.first.elastic_value - work.to_first;
  if (memory.elastic_energy >= 0 && memory.steps > 1) work.numerical -= start - memory.elastic_energy;
  const double foreseen = start + work.stored;
  memory.elastic_energy = std::max(0.0, foreseen);  // far from the forces' linear range it may be negative
  work.numerical -= memory.elastic_energy - foreseen;
}

// A single iteration does not move far and starts from the inertial prediction. With more iterations, the error that
// the last step has left is small beside a large motion only, see predict().
bool ImplicitStepper::extrapolates(bool fallback) const {
  return !fallback && settings_.iterations == 1;
}

// @returns the length of the motion that is foreseen [m]; 0: none is
double ImplicitStepper::guess(const MotionView& motion, bool fallback, StepperWorkspace& scratch) const {
  const TimeScheme& scheme = fallback ? plan_->fallback_scheme : plan_->scheme;
  const bool from_hat = extrapolates(fallback);
  for (int i = 0; i < body_.nodeCount(); ++i)
    for (int k = 0; k < 3; ++k) {
      const double x = motion.x[k][i];
      const double hat = body_.fixed[i] != 0 ? x : scheme.hat_z(x, motion.v[k][i], motion.a[k][i]);
      scratch.z_hat[4 * i + k] = hat;
      if (!scratch.solved) scratch.z[4 * i + k] = from_hat ? hat : x;
    }
  if (scratch.solved) return scratch.motion_length;
  if (from_hat || fallback) return 0;
  if (!plan_->free) return predict(motion, scheme, scratch);
  moveRigidly(body_, motion, scheme, scratch);
  return 0;
}

// A large motion goes on with its velocity, and the step has to find only what changes it. The velocity has the error
// that the last step has left, which its iterations have brought below a hundredth of such a motion. Of a small one it
// may be all, and would grow from step to step.
double ImplicitStepper::predict(const MotionView& motion, const TimeScheme& scheme, StepperWorkspace& scratch) const {
  const double ahead = scheme.part() * scheme.h;
  double fastest2 = 0;
  for (int i = 0; i < body_.nodeCount(); ++i) {
    double speed2 = 0;
    for (int k = 0; k < 3 && body_.fixed[i] == 0; ++k) speed2 += motion.v[k][i] * motion.v[k][i];
    fastest2 = std::max(fastest2, speed2);
  }
  const double length = ahead * std::sqrt(fastest2);
  if (!(length > plan_->safe_length)) return 0;
  for (int i = 0; i < body_.nodeCount(); ++i)
    for (int k = 0; k < 3 && body_.fixed[i] == 0; ++k) scratch.z[4 * i + k] += ahead * motion.v[k][i];
  return length;
}

void ImplicitStepper::iterateStep(const MotionView& motion, BodyLoads& loads, StepperMemory& memory,
                                  StepperWorkspace& scratch, const std::function<bool()>& accepts,
                                  StepOutcome& outcome) const {
  const TimeScheme& scheme = outcome.fallback ? plan_->fallback_scheme : plan_->scheme;
  const bool again = std::exchange(scratch.refused, false);
  const double foreseen = again ? scratch.foreseen : guess(motion, outcome.fallback, scratch);
  buildRows(loads, motion, scratch);
  setStepTargets(loads, motion, scheme, memory.couplings, scratch);
  Potential potential(body_, loads, scheme.inertia, scratch, scheme.part());
  QuasiNewton newton(body_, potential, loads, scratch, std::min(plan_->safe_length, kUsualGrowth * memory.usual_length),
                     evaluationsLeft(outcome.fallback, scratch.spent));
  again ? newton.start(scratch.value) : newton.start();
  newton.judgeBy(foreseen);
  const bool guessed = !scratch.solved && (foreseen > 0 || extrapolates(outcome.fallback));
  // a guess with far more energy may be tangled and lead to a tangled minimum: then start from the present positions
  if (guessed && !(scratch.last.elastic_value <= kGuessGrowth * memory.elastic_energy))
    startFromHere(motion, newton, scratch);
  if (!scratch.solved) scratch.first = scratch.last;
  {
    const InStage stage(scratch.stages, StepStage::Factor);
    scratch.schur.setRows(scratch.rows, *scratch.factor, scratch.columns);
  }
  newton.setGas(foreseenVolume(loads.gas, motion, scheme, scratch));
  if (guessed && newton.judgedBy() > 0) {
    newton.aim();
    if (!(newton.directionLength() < kMisled * foreseen)) {
      startFromHere(motion, newton, scratch);
      scratch.first = scratch.last;
      newton.setGas(foreseenVolume(loads.gas, motion, scheme, scratch));
    }
  }
  chooseContacts(motion, loads, scheme, newton, scratch);
  if (accepts) {
    newton.aim();
    storeToolForces(scratch, loads);
    if (!accepts()) return refuse(newton, scratch, outcome);
  }
  iterate(newton, scratch, memory, outcome);
  outcome.finite = std::isfinite(outcome.last_move) && std::isfinite(newton.value());
  scratch.motion_length = outcome.arrived && !outcome.fallback ? newton.judgedBy() : 0;
  scratch.gas_stiffness = potential.gas().stiffness(scratch.last.volume);
}

// The next solve begins at the same guess, if that was of use, so that its evaluation is known.
void ImplicitStepper::refuse(const QuasiNewton& newton, StepperWorkspace& scratch, StepOutcome& outcome) {
  outcome.refused = true;
  scratch.refused = newton.judgedBy() > 0;
  outcome.evaluations = newton.evaluations();
  scratch.spent += outcome.evaluations;
  scratch.value = newton.value();
  scratch.foreseen = newton.judgedBy();
  scratch.motion_length = 0;
}

// Which contacts will push is known only after a direction was found.
void ImplicitStepper::chooseContacts(const MotionView& motion, const BodyLoads& loads, const TimeScheme& scheme,
                                     QuasiNewton& newton, StepperWorkspace& scratch) const {
  if (scratch.rows.counted == scratch.rows.contacts.size()) return;
  for (int n = 0; n < kExchanges && exchangeContacts(loads, motion, scheme, newton.foreseen(), scratch); ++n) {
    scratch.schur.setRows(scratch.rows, *scratch.factor, scratch.columns);
    newton.takeRows();
  }
}

// What the solves of a step may take together leaves each of them enough for its least number of iterations.
int ImplicitStepper::evaluationsLeft(bool fallback, int spent) const {
  const int usual = settings_.iterations + kSpareEvaluations;
  return std::clamp(2 * usual - spent, settings_.iterations + kLeastSpare,
                    fallback ? settings_.iterations + kSpareInFallback : usual);
}

// Iterations go on until they contract: otherwise stiff motions would grow from step to step.
void ImplicitStepper::iterate(QuasiNewton& newton, StepperWorkspace& scratch, StepperMemory& memory,
                              StepOutcome& outcome) const {
  const double longest = outcome.fallback ? kFallbackMaxMove * plan_->size : std::numeric_limits<double>::max();
  bool done = false;
  while (!done && !outcome.converged && !newton.exhausted() && std::isfinite(outcome.last_move) &&
         (!newton.failed() || newton.startAgain())) {
    newton.aim();
    const bool tiny = newton.directionLength() < std::max(settings_.tolerance, newton.resolution());
    outcome.last_move = newton.iterate(longest, !tiny && outcome.iterations + 1 < settings_.iterations);
    if (++outcome.iterations == kSatisfyConstraints && !newton.exhausted() && newton.satisfyConstraints())
      continue;  // and on from there
    done = outcome.iterations >= settings_.iterations && newton.contracts();
    outcome.converged = tiny;
  }
  const double first_length = newton.judgedBy();
  if (!scratch.solved) memory.usual_length += kUsualShare * (first_length - memory.usual_length);
  const double enough = newton.failed()
                            ? std::max(kNearlyArrived * first_length, kPositionRoundings * newton.resolution())
                            : kArrived * first_length;
  outcome.arrived = outcome.converged || done || newton.directionLength() < enough;
  outcome.residual = std::max({newton.residual(), scratch.schur.violation(), depthLeftOut(scratch.z, scratch)});
  outcome.evaluations = newton.evaluations();
  scratch.spent += outcome.evaluations;
  outcome.solves = newton.solves();
}

void ImplicitStepper::startFromHere(const MotionView& motion, QuasiNewton& newton, StepperWorkspace& scratch) const {
  toPresent(motion, scratch);
  newton.start();
  newton.judgeBy(0);
}

void ImplicitStepper::toPresent(const MotionView& motion, StepperWorkspace& scratch) const {
  for (int i = 0; i < body_.nodeCount(); ++i)
    for (int k = 0; k < 3; ++k) scratch.z[4 * i + k] = motion.x[k][i];
}

StepOutcome ImplicitStepper::settle(MotionView motion, BodyLoads& loads, StepperWorkspace& scratch, double tolerance,
                                    int max_iterations) const {
  if (scratch.making) scratch.making->finish();
  scratch.factor_id = scratch.next_id = 0;
  toPresent(motion, scratch);
  buildRows(loads, motion, scratch);
  setEquilibriumTargets(loads, scratch);
  Potential potential(body_, loads, 0, scratch);
  QuasiNewton newton(body_, potential, loads, scratch);
  StepOutcome outcome;
  double before = std::numeric_limits<double>::max();
  while (outcome.iterations < max_iterations && !outcome.converged && std::isfinite(outcome.last_move)) {
    const bool slow = newton.directionLength() > kSlow * before;
    before = newton.directionLength();
    if (outcome.iterations % kRefactorEvery == 0 || (slow && outcome.iterations % kRefactorSlow == 0)) {
      refactorHere(loads, scratch);
      newton.start();
      ++outcome.refactorisations;
    }
    newton.setGas(scratch.last.volume);
    outcome.last_move = newton.iterate(kFallbackMaxMove * plan_->size, true);
    ++outcome.iterations;
    outcome.converged = newton.directionLength() < std::max(tolerance, newton.resolution());
    if (newton.failed()) newton.start();
  }
  outcome.finite = std::isfinite(outcome.last_move);
  if (!outcome.finite) return outcome;
  storeForces(scratch, 1, loads);
  placeAtRest(scratch, motion);
  return outcome;
}

void ImplicitStepper::refactorHere(const BodyLoads& loads, StepperWorkspace& scratch) const {
  std::vector<float> positions(3 * body_.rest.size());
  for (std::size_t i = 0; i < body_.rest.size(); ++i)
    for (std::size_t k = 0; k < 3; ++k) positions[3 * i + k] = static_cast<float>(scratch.z[4 * i + k]);
  std::vector<StiffnessCoupling> couplings;
  collectCouplings(loads, scratch.z.data(), 1, couplings);
  scratch.returnLent();
  if (!factorAt(body_, {positions, couplings}, 0, 1, scratch.plan, scratch.matrix, *scratch.factor, *scratch.pool))
    factorAt(body_, {{}, {}}, 0, 1, scratch.plan, scratch.matrix, *scratch.factor, *scratch.pool);
  scratch.columns.reset();
  scratch.columns.setAttachments(*scratch.factor, loads.attachments);
  scratch.schur.reset(*scratch.factor);
  findMissingTurns(loads, couplings, scratch.rows);
  scratch.schur.setRows(scratch.rows, *scratch.factor, scratch.columns);
}

void ImplicitStepper::placeAtRest(const StepperWorkspace& scratch, const MotionView& motion) const {
  for (int i = 0; i < body_.nodeCount(); ++i)
    for (int k = 0; k < 3; ++k) {
      motion.x[k][i] = scratch.z[4 * i + k];
      motion.v[k][i] = motion.a[k][i] = 0;
    }
}

double ImplicitStepper::elasticEnergy(const MotionView& motion, StepperWorkspace& scratch) const {
  for (int i = 0; i < body_.nodeCount(); ++i)
    for (int k = 0; k < 3; ++k)
      scratch.last.displacement[4 * i + k] = static_cast<float>(motion.x[k][i] - body_.rest[i][k]);
  std::fill(scratch.work.begin(), scratch.work.end(), 0.0F);
  if (!scratch.shared.shares.empty())
    return scratch.shared.evaluate(*body_.shell, *scratch.pool, scratch.last.displacement.data(), scratch.work.data(),
                                   nullptr);
  double energy = 0;
  for (int p = 0; p < body_.elements->pieceCount(); ++p)
    energy += body_.elements->evaluate(p, scratch.last.displacement.data(), scratch.work.data());
  return energy;
}

}  // namespace vibe
