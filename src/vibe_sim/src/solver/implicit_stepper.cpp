#include "vibe_sim/solver/implicit_stepper.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include "quasi_newton.hpp"
#include "time_scheme.hpp"
#include "vibe_sim/error.hpp"

namespace vibe {

namespace {

// A step of one iteration swings up where the stiffness exceeds that of the factor (its error (1 - ratio) enters the
// acceleration), one of two from twice that on.
constexpr double kMarginOfOne = 2;
constexpr int kRefactorEvery = 6;   // iterations of a static solve
constexpr double kGuessGrowth = 2;  // of the elastic energy that a guess may bring
constexpr int kCarefulSteps = 10;
constexpr int kCarefulIterations = 12;
constexpr double kCarefulMove = 0.05;  // of the size of the body, per iteration
constexpr double kSafeStrain = 0.02;   // which a last, unverified move may bring where it is longest
constexpr double kShift = 1e-7;        // of the stiffness, so that a free body can be factored

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

StepperScratch::StepperScratch(const std::vector<Eigen::Vector3d>& rest_positions,
                               std::shared_ptr<const FactorPlan> plan, FactorStorage storage,
                               std::shared_ptr<const BlockPattern> pattern)
    : factor(std::make_unique<Factor>(plan, storage)),
      next_factor(std::make_unique<Factor>(plan, storage)),
      matrix(pattern),
      next_matrix(pattern) {
  const std::size_t size = 4 * rest_positions.size();
  for (auto* v : {&rest, &z, &z_hat, &trial}) v->assign(size, 0);
  for (auto* v : {&displacement, &gradient, &trial_gradient, &volume_gradient, &direction, &work}) v->assign(size, 0);
  for (std::size_t i = 0; i < rest_positions.size(); ++i)
    for (int k = 0; k < 3; ++k) rest[4 * i + k] = rest_positions[i][k];
  half.assign(3 * rest_positions.size() + 16, 0);
  move.assign(kHistory, std::vector<float>(size));
  change.assign(kHistory, std::vector<float>(size));
  curvature.assign(kHistory, 0);
}

StepperScratch::~StepperScratch() {
  if (making.valid()) making.wait();
}

struct ImplicitStepper::Plan {
  std::shared_ptr<const BlockPattern> pattern;
  std::shared_ptr<const FactorPlan> factor_plan;
  TimeScheme scheme, careful_scheme;
  FactorStorage storage;
  double margin;       ///< times the stiffness in the factor
  int refactor_every;  ///< steps
};

namespace {

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

}  // namespace

ImplicitStepper::ImplicitStepper(ElasticBody body, StepSettings settings, FactorStorage storage)
    : body_(std::move(body)), settings_(settings) {
  const TimeScheme scheme(settings, body_.damping_rate, body_.damping_time);
  StepSettings careful = settings;
  careful.backward_euler = true;
  const TimeScheme careful_scheme(careful, body_.damping_rate, body_.damping_time);
  for (const Eigen::Vector3d& p : body_.rest) size_ = std::max(size_, (p - body_.rest[0]).norm());
  free_ = body_.foundation.empty() &&
          std::none_of(body_.fixed.begin(), body_.fixed.end(), [](char fixed) { return fixed != 0; });
  safe_length_ = kSafeStrain * shortestDistance(body_);
  const double margin = settings.iterations == 1 && !settings.backward_euler ? kMarginOfOne : 1;
  const int every = settings.refactor_interval > 0
                        ? std::max(1, static_cast<int>(std::lround(settings.refactor_interval / settings.step)))
                        : 0;
  auto pattern = std::make_shared<const BlockPattern>(blockPattern(body_.nodeCount(), body_.elements->nodeGroups()));
  auto factor_plan = makeFactorPlan(*pattern);
  plan_ = std::make_unique<Plan>(
      Plan{std::move(pattern), std::move(factor_plan), scheme, careful_scheme, storage, margin, every});
}

ImplicitStepper::~ImplicitStepper() = default;

namespace {

// inertia M + margin K + foundation, fixed nodes taken out
bool factorAbout(const ElasticBody& body, const std::vector<float>& positions, double inertia, double margin,
                 BlockMatrix& matrix, Factor& factor) {
  const std::size_t n = body.rest.size();
  std::vector<double> displacement(3 * n, 0.0);
  if (!positions.empty())
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t k = 0; k < 3; ++k)
        displacement[3 * i + k] =
            static_cast<double>(positions[3 * i + k]) - body.rest[i][static_cast<Eigen::Index>(k)];
  matrix.setZero();
  body.elements->addStiffness(displacement.data(), matrix);
  if (margin != 1) matrix.scale(margin);
  double mean = 0;
  for (std::size_t i = 0; i < n; ++i) mean += matrix.diagonal()[i].trace() / (3 * static_cast<double>(n));
  for (std::size_t i = 0; i < n; ++i) {
    double spring = inertia * body.mass[i] + kShift * mean;
    if (!body.foundation.empty()) spring += body.foundation[i];
    matrix.add(static_cast<int>(i), static_cast<int>(i), spring * Eigen::Matrix3d::Identity());
  }
  for (std::size_t i = 0; i < n; ++i)
    if (body.fixed[i] != 0) matrix.fix(static_cast<int>(i));
  return factor.compute(matrix);
}

// A matrix that is not positive definite for rounding (a squashed state) gets help; one about rest is the last resort.
void factorSafely(const ElasticBody& body, const std::vector<float>& positions, double inertia, double margin,
                  BlockMatrix& matrix, Factor& factor) {
  if (factorAbout(body, positions, inertia, margin, matrix, factor)) return;
  if (factorAbout(body, {}, inertia, margin, matrix, factor)) return;
  throw Error("The stiffness of the body at rest is not positive definite; check its mesh, masses and materials.");
}

std::uint64_t hashOf(const std::vector<float>& values) {  // FNV-1a over 32-bit words; 1: nothing
  std::uint64_t hash = 1469598103934665603ULL;
  for (float value : values) {
    std::uint32_t bits = 0;
    std::memcpy(&bits, &value, sizeof bits);
    hash = (hash ^ bits) * 1099511628211ULL;
  }
  return values.empty() ? 1 : hash;
}

void copyPositions(const MotionView& motion, int nodes, std::vector<float>& out) {
  out.resize(3 * static_cast<std::size_t>(nodes));
  for (int i = 0; i < nodes; ++i)
    for (int k = 0; k < 3; ++k) out[3 * static_cast<std::size_t>(i) + k] = static_cast<float>(motion.x[k][i]);
}

// The conditions and contacts of the loads as rows for the unknown z; `scale` and the frees carry the time scheme.
class RowBuilder {
 public:
  RowBuilder(const BodyLoads& loads, StepperScratch& scratch) : loads_(loads), scratch_(scratch) {}

  void build() {
    std::vector<HalfRow>& rows = scratch_.rows;
    rows.resize(loads_.conditions.size() + 3 * loads_.contacts.size());
    std::size_t r = 0;
    for (const Condition& condition : loads_.conditions) {
      rows[r].node = condition.node;
      rows[r].coefficient = condition.coefficient;
      rows[r].compliance = condition.compliance;
      rows[r++].friction = -1;
    }
    for (const ContactCondition& contact : loads_.contacts) addContact(contact, r), r += 3;
    const auto count = static_cast<Eigen::Index>(rows.size());
    scratch_.target.resize(count);
    scratch_.wanted.resize(count);
  }

 private:
  void addContact(const ContactCondition& contact, std::size_t r) {
    const Eigen::Vector3d n = contact.normal;
    const Eigen::Vector3d t1 = n.unitOrthogonal();
    const Eigen::Vector3d directions[3] = {n, t1, n.cross(t1)};
    for (std::size_t k = 0; k < 3; ++k) {
      scratch_.rows[r + k].node.assign(1, contact.node);
      scratch_.rows[r + k].coefficient.assign(1, directions[k]);
      scratch_.rows[r + k].compliance = 0;
      scratch_.rows[r + k].friction = contact.friction;
    }
  }

  const BodyLoads& loads_;
  StepperScratch& scratch_;
};

double rowTarget(const BodyLoads& loads, const std::vector<HalfRow>& rows, std::size_t r) {
  if (r < loads.conditions.size()) return loads.conditions[r].target;
  const std::size_t k = (r - loads.conditions.size()) % 3;
  const ContactCondition& contact = loads.contacts[(r - loads.conditions.size()) / 3];
  return k == 0 ? contact.offset : rows[r].coefficient[0].dot(contact.anchor);
}

void storeForces(const Eigen::VectorXd& force, const std::vector<HalfRow>& rows, BodyLoads& loads) {
  Eigen::Index r = 0;
  for (Condition& condition : loads.conditions) condition.force = force[r++];
  for (ContactCondition& contact : loads.contacts) {
    contact.force.setZero();
    for (int k = 0; k < 3; ++k, ++r) contact.force += force[r] * rows[static_cast<std::size_t>(r)].coefficient[0];
  }
}

}  // namespace

namespace {

// Moves a free body's z rigidly by what its velocities and accelerations make of it: however far, that does not strain.
void moveRigidly(const ElasticBody& body, const MotionView& motion, const TimeScheme& scheme, StepperScratch& scratch) {
  const auto at = [&](int i) { return Eigen::Map<Eigen::Vector3d>(&scratch.z[4 * i]); };
  const auto move = [&](int i) {
    Eigen::Vector3d sum;
    for (int k = 0; k < 3; ++k)
      sum[k] = scheme.free_z(0, motion.v[k][i], motion.a[k][i]) + scheme.z_gain * motion.a[k][i];
    return sum;
  };
  Eigen::Vector3d center = Eigen::Vector3d::Zero(), shift = center, spin = center;
  Eigen::Matrix3d inertia = Eigen::Matrix3d::Zero();
  double mass = 0;
  for (int i = 0; i < body.nodeCount(); ++i) {
    mass += body.mass[i];
    center += body.mass[i] * at(i);
    shift += body.mass[i] * move(i);
  }
  center /= mass, shift /= mass;
  for (int i = 0; i < body.nodeCount(); ++i) {
    const Eigen::Vector3d arm = at(i) - center;
    spin += body.mass[i] * arm.cross(move(i));
    inertia += body.mass[i] * (arm.squaredNorm() * Eigen::Matrix3d::Identity() - arm * arm.transpose());
  }
  inertia += 1e-9 * inertia.trace() * Eigen::Matrix3d::Identity();  // of nodes in a line
  const Eigen::Vector3d turn = inertia.ldlt().solve(spin);
  const double angle = turn.norm();
  const Eigen::AngleAxisd rotation(angle, angle > 0 ? Eigen::Vector3d(turn / angle) : Eigen::Vector3d::UnitX());
  for (int i = 0; i < body.nodeCount(); ++i) at(i) = center + shift + rotation * Eigen::Vector3d(at(i) - center);
}

}  // namespace

std::shared_ptr<StepperScratch> ImplicitStepper::makeScratch() const {
  return std::make_shared<StepperScratch>(body_.rest, plan_->factor_plan, plan_->storage, plan_->pattern);
}

void ImplicitStepper::refactor(const MotionView& motion, StepperMemory& memory) const {
  copyPositions(motion, body_.nodeCount(), memory.about);
  memory.about_id = hashOf(memory.about);
  memory.next.clear();
}

// The memory says which factor a step uses; the scratch provides it, from the background if it is there already.
void ImplicitStepper::manageFactor(const MotionView& motion, StepperMemory& memory, StepperScratch& scratch) const {
  if (memory.about_id == 0) memory.about_id = hashOf(memory.about);
  const int every = plan_->refactor_every;
  if (every > 0 && memory.steps % every == 0) {
    if (!memory.next.empty()) {
      memory.about.swap(memory.next);
      memory.about_id = memory.next_id;
      memory.next.clear();
    }
    if (farFrom(motion, memory.about)) {
      copyPositions(motion, body_.nodeCount(), memory.next);
      memory.next_id = hashOf(memory.next);
    }
  }
  if (scratch.factor_id != memory.about_id) {
    if (scratch.making.valid()) scratch.making.get();
    if (scratch.next_id == memory.about_id) {
      scratch.factor.swap(scratch.next_factor);
    } else {
      factorSafely(body_, memory.about, plan_->scheme.inertia, plan_->margin, scratch.matrix, *scratch.factor);
    }
    scratch.next_id = 0;
    scratch.factor_id = memory.about_id;
    scratch.half_space.reset(*scratch.factor, body_.nodeCount());
  }
  if (!memory.next.empty() && scratch.next_id != memory.next_id) {
    if (scratch.making.valid()) scratch.making.get();
    scratch.next_id = memory.next_id;
    scratch.making = std::async(std::launch::async, [this, &scratch, positions = memory.next] {
      factorSafely(body_, positions, plan_->scheme.inertia, plan_->margin, scratch.next_matrix, *scratch.next_factor);
      return true;
    });
  }
}

bool ImplicitStepper::farFrom(const MotionView& motion, const std::vector<float>& about) const {
  const double limit2 = settings_.refactor_distance * settings_.refactor_distance;
  for (int i = 0; i < body_.nodeCount(); ++i) {
    double distance2 = 0;
    for (int k = 0; k < 3; ++k) {
      const double from =
          about.empty() ? body_.rest[i][k] : static_cast<double>(about[3 * static_cast<std::size_t>(i) + k]);
      distance2 += (motion.x[k][i] - from) * (motion.x[k][i] - from);
    }
    if (!(distance2 <= limit2)) return true;
  }
  return false;
}

StepOutcome ImplicitStepper::step(MotionView motion, BodyLoads& loads, StepperMemory& memory,
                                  StepperScratch& scratch) const {
  manageFactor(motion, memory, scratch);
  ++memory.steps;
  StepOutcome outcome;
  outcome.careful = settings_.backward_euler || memory.careful > 0;
  if (memory.careful > 0) --memory.careful;
  if (!attempt(motion, loads, outcome.careful, memory.elastic_energy, scratch, outcome) && !outcome.careful) {
    memory.careful = kCarefulSteps;
    outcome = StepOutcome();
    outcome.careful = true;
    attempt(motion, loads, true, memory.elastic_energy, scratch, outcome);
  }
  if (!outcome.finite) return outcome;
  storeForces(scratch.half_space.forces(), scratch.rows, loads);
  loads.gas.volume = scratch.volume;
  loads.gas.pressure = scratch.pressure;
  finishStep(motion, outcome.careful, scratch);
  return outcome;
}

// @returns false where no lower energy was found
bool ImplicitStepper::attempt(const MotionView& motion, BodyLoads& loads, bool careful, double& elastic_energy,
                              StepperScratch& scratch, StepOutcome& outcome) const {
  const TimeScheme& scheme = careful ? plan_->careful_scheme : plan_->scheme;
  // One iteration does not get far and starts where inertia leads. More of them start where the nodes are: what the
  // iterations of the last step left over is in the velocity and the acceleration, and would swing up.
  const bool extrapolates = !careful && settings_.iterations == 1;
  for (int i = 0; i < body_.nodeCount(); ++i)
    for (int k = 0; k < 3; ++k) {
      const double x = motion.x[k][i];
      const double hat = body_.fixed[i] != 0 ? x : scheme.hat_z(x, motion.v[k][i], motion.a[k][i]);
      scratch.z_hat[4 * i + k] = hat;
      scratch.z[4 * i + k] = extrapolates ? hat : x;
    }
  if (!extrapolates && !careful && free_) moveRigidly(body_, motion, scheme, scratch);
  RowBuilder(loads, scratch).build();
  for (std::size_t r = 0; r < scratch.rows.size(); ++r) {
    double end = rowTarget(loads, scratch.rows, r), at = 0;  // wanted at the end of the step; that for z
    for (std::size_t k = 0; k < scratch.rows[r].node.size(); ++k)
      for (int c = 0; c < 3; ++c) {
        const int i = scratch.rows[r].node[k];
        const double weight = scratch.rows[r].coefficient[k][c];
        end -= weight * scheme.free_x(motion.x[c][i], motion.v[c][i], motion.a[c][i]);
        at += weight * scheme.free_z(motion.x[c][i], motion.v[c][i], motion.a[c][i]);
      }
    scratch.target[static_cast<Eigen::Index>(r)] = at + scheme.z_gain / scheme.x_gain * end;
    scratch.rows[r].compliance *= scheme.z_gain / scheme.x_gain;
  }
  Potential potential(body_, loads, scheme.inertia, scratch);
  QuasiNewton newton(body_, potential, loads, scratch, safe_length_);
  newton.start();
  // a guess with far more energy may be tangled and lead to a tangled minimum: then from where the nodes are
  if (extrapolates && !(potential.elasticEnergy() <= kGuessGrowth * elastic_energy)) {
    startFromHere(motion, scratch);
    newton.start();
  }
  scratch.half_space.setRows(scratch.rows, *scratch.factor);
  scratch.half_space.setGas(scratch.volume_gradient.data(), potential.gasStiffness(), *scratch.factor);
  const int least = careful && !settings_.backward_euler ? kCarefulIterations : 1;
  const int most = std::max(least, settings_.iterations);
  const double longest = careful ? kCarefulMove * size_ : std::numeric_limits<double>::max();
  while (outcome.iterations < most && !outcome.converged && !newton.failed()) {
    outcome.last_move = newton.iterate(longest, outcome.iterations + 1 < most);
    outcome.converged = newton.directionLength() < std::max(settings_.tolerance, newton.resolution());
    ++outcome.iterations;
  }
  outcome.finite = std::isfinite(outcome.last_move) && std::isfinite(newton.value());
  elastic_energy = potential.elasticEnergy();
  // where all that is left to move is rounding, so is the energy that does not fall
  return outcome.finite && (outcome.converged || !newton.failed());
}

void ImplicitStepper::startFromHere(const MotionView& motion, StepperScratch& scratch) const {
  for (int i = 0; i < body_.nodeCount(); ++i)
    for (int k = 0; k < 3; ++k) scratch.z[4 * i + k] = motion.x[k][i];
}

void ImplicitStepper::finishStep(const MotionView& motion, bool careful, StepperScratch& scratch) const {
  const TimeScheme& scheme = careful ? plan_->careful_scheme : plan_->scheme;
  const double per_gain = 1 / scheme.z_gain;
  for (int k = 0; k < 3; ++k) {
    double *const x = motion.x[k], *const v = motion.v[k], *const a = motion.a[k];
    const double* const z = scratch.z.data() + k;
    for (int i = 0; i < body_.nodeCount(); ++i) {
      if (body_.fixed[i] != 0) continue;
      const double end = (z[4 * i] - scheme.free_z(x[i], v[i], a[i])) * per_gain;
      x[i] = scheme.free_x(x[i], v[i], a[i]) + scheme.x_gain * end;
      v[i] += scheme.free_v_a * a[i] + scheme.v_gain * end;
      a[i] = end;
    }
  }
}

StepOutcome ImplicitStepper::settle(MotionView motion, BodyLoads& loads, StepperScratch& scratch, double tolerance,
                                    int most_iterations) const {
  const int n = body_.nodeCount();
  std::vector<float> positions(3 * static_cast<std::size_t>(n));
  if (scratch.making.valid()) scratch.making.get();
  scratch.factor_id = scratch.next_id = 0;
  for (int i = 0; i < n; ++i)
    for (int k = 0; k < 3; ++k) {
      scratch.z[4 * i + k] = motion.x[k][i];
    }
  RowBuilder(loads, scratch).build();
  for (std::size_t r = 0; r < scratch.rows.size(); ++r)
    scratch.target[static_cast<Eigen::Index>(r)] = rowTarget(loads, scratch.rows, r);
  Potential potential(body_, loads, 0, scratch);
  QuasiNewton newton(body_, potential, loads, scratch);
  StepOutcome outcome;
  double before = std::numeric_limits<double>::max();
  while (outcome.iterations < most_iterations && !outcome.converged) {
    const bool slow = newton.directionLength() > 0.3 * before;
    before = newton.directionLength();
    if (outcome.iterations % kRefactorEvery == 0 || (slow && outcome.iterations % 3 == 0)) {
      for (int i = 0; i < n; ++i)
        for (int k = 0; k < 3; ++k)
          positions[3 * static_cast<std::size_t>(i) + k] = static_cast<float>(scratch.z[4 * i + k]);
      if (!factorAbout(body_, positions, 0, 1, scratch.matrix, *scratch.factor))
        factorAbout(body_, {}, 0, 1, scratch.matrix, *scratch.factor);
      scratch.half_space.reset(*scratch.factor, n);
      scratch.half_space.setRows(scratch.rows, *scratch.factor);
      newton.start();
      ++outcome.refactorisations;
    }
    scratch.half_space.setGas(scratch.volume_gradient.data(), potential.gasStiffness(), *scratch.factor);
    outcome.last_move = newton.iterate(0.05 * size_, true);
    ++outcome.iterations;
    outcome.converged = newton.directionLength() < std::max(tolerance, newton.resolution());
    if (!std::isfinite(outcome.last_move)) break;
    if (newton.failed()) newton.start();
  }
  outcome.finite = std::isfinite(outcome.last_move);
  if (!outcome.finite) return outcome;
  storeForces(scratch.half_space.forces(), scratch.rows, loads);
  loads.gas.volume = scratch.volume;
  loads.gas.pressure = scratch.pressure;
  for (int i = 0; i < n; ++i)
    for (int k = 0; k < 3; ++k) {
      motion.x[k][i] = scratch.z[4 * i + k];
      motion.v[k][i] = motion.a[k][i] = 0;
    }
  return outcome;
}

double ImplicitStepper::elasticEnergy(const MotionView& motion, StepperScratch& scratch) const {
  for (int i = 0; i < body_.nodeCount(); ++i)
    for (int k = 0; k < 3; ++k) scratch.displacement[4 * i + k] = static_cast<float>(motion.x[k][i] - body_.rest[i][k]);
  std::fill(scratch.work.begin(), scratch.work.end(), 0.0F);
  double energy = 0;
  for (int p = 0; p < body_.elements->pieceCount(); ++p)
    energy += body_.elements->evaluate(p, scratch.displacement.data(), scratch.work.data());
  return energy;
}

}  // namespace vibe
