#include "solver/stepper_workspace.hpp"

#include <algorithm>
#include <cstring>
#include <iterator>
#include <thread>
#include <utility>

#include "solver/couplings.hpp"
#include "vibe_core/program/error.hpp"
#include "vibe_core/solver/energy_term.hpp"
#include "vibe_core/tissue/shell.hpp"

namespace vibe {

namespace {
// Into which a shell is divided at most. Design choice: each share costs copies along its border.
constexpr int kMostShares = 4;

// For a factor, beside the threads of the steps: as many as those have where there are processors for them.
int spareThreads(int of_steps) {
  return std::clamp(static_cast<int>(std::thread::hardware_concurrency()) - of_steps, 1, of_steps);
}
}  // namespace

StepperWorkspace::StepperWorkspace(const std::vector<Eigen::Vector3d>& rest_positions,
                                   std::shared_ptr<const FactorPlan> elements_plan, FactorStorage storage_of_factor,
                                   std::shared_ptr<const BlockPattern> pattern, std::shared_ptr<FactorShelf> factors)
    : plan(std::move(elements_plan)),
      storage(storage_of_factor),
      shelf(std::move(factors)),
      factor(std::make_shared<Factor>(plan, storage)),
      next_factor(std::make_shared<Factor>(plan, storage)),
      matrix(std::move(pattern)) {
  const std::size_t size = 4 * rest_positions.size();
  for (auto* v : {&rest, &z, &z_hat, &trial}) v->assign(size, 0);
  for (auto* v : {&gradient, &trial_gradient, &direction, &work}) v->assign(size, 0);
  for (Evaluation* e : {&last, &first, &kept})
    for (auto* v : {&e->displacement, &e->elastic_gradient, &e->extra_gradient, &e->volume_gradient})
      v->assign(size, 0);
  for (std::size_t i = 0; i < rest_positions.size(); ++i)
    for (int k = 0; k < 3; ++k) rest[4 * i + k] = rest_positions[i][k];
  half.assign(3 * rest_positions.size() + 16, 0);
  move.assign(kHistory, std::vector<float>(size));
  change.assign(kHistory, std::vector<float>(size));
  curvature.assign(kHistory, 0);
}

StepperWorkspace::~StepperWorkspace() {
  making.reset();  // it works on the other members
}

void StepperWorkspace::use(ThreadPool& threads, const ShellElements* shell) {
  pool = &threads;
  schur.use(threads);
  if (shared.threads == threads.threads()) return;
  shared.threads = threads.threads();
  if (making) making->finish();
  making_pool.reset();
  making_threads = spareThreads(shared.threads);
  shared.shares.clear();
  if (shell == nullptr || shared.threads == 1) return;
  for (ShellPart& part : shell->partsOf(std::min(shared.threads, kMostShares))) {
    const std::vector<float> zeros(part.size(), 0.0F);
    shared.shares.push_back({std::move(part), zeros, zeros, zeros});
  }
  for (auto* v : {&shared.value, &shared.volume}) v->assign(static_cast<std::size_t>(shell->pieceCount()), 0);
}

double SharedEvaluation::evaluate(const ShellElements& shell, ThreadPool& pool, const float* displacement,
                                  float* gradient, float* volume_gradient) {
  pool.parallelFor(1 + static_cast<int>(shares.size()), 1, [&](int k, int) {
    if (k == 0)
      evaluatePieces(shell, shares.front().part.first_piece, displacement, gradient, volume_gradient);
    else
      evaluateShare(shell, shares[static_cast<std::size_t>(k) - 1], displacement, gradient, volume_gradient);
  });
  for (const Share& share : shares)
    for (std::size_t i = 0; i < share.part.copies.size(); ++i) {
      const std::size_t from = 4 * (share.part.own.size() + i), to = 4 * static_cast<std::size_t>(share.part.copies[i]);
      for (std::size_t c = 0; c < 3; ++c) {
        gradient[to + c] += share.gradient[from + c];
        if (volume_gradient != nullptr) volume_gradient[to + c] += share.volume_gradient[from + c];
      }
    }
  double energy = 0;
  for (const double part : value) energy += part;
  return energy;
}

// To the vectors of all nodes.
void SharedEvaluation::evaluatePieces(const ShellElements& shell, int last, const float* displacement, float* gradient,
                                      float* volume_gradient) {
  for (int p = 0; p < last; ++p) {
    double enclosed = 0;
    value[static_cast<std::size_t>(p)] = volume_gradient != nullptr
                                             ? shell.evaluate(p, displacement, gradient, volume_gradient, enclosed)
                                             : shell.evaluate(p, displacement, gradient);
    volume[static_cast<std::size_t>(p)] = enclosed;
  }
}

// To the vectors of the share, and from there to the nodes that nobody else adds to meanwhile.
void SharedEvaluation::evaluateShare(const ShellElements& shell, Share& share, const float* displacement,
                                     float* gradient, float* volume_gradient) {
  const ShellPart& part = share.part;
  float* to = share.displacement.data();
  for (const std::vector<int>* nodes : {&part.own, &part.copies})
    for (const int node : *nodes) to = std::copy_n(displacement + 4 * static_cast<std::size_t>(node), 4, to);
  for (std::vector<float>* sum : {&share.gradient, &share.volume_gradient}) std::fill(sum->begin(), sum->end(), 0.0F);
  for (int p = part.first_piece; p < part.last_piece; ++p) {
    double enclosed = 0;
    value[static_cast<std::size_t>(p)] =
        shell.evaluate(part, p, share.displacement.data(), share.gradient.data(),
                       volume_gradient != nullptr ? share.volume_gradient.data() : nullptr, enclosed);
    volume[static_cast<std::size_t>(p)] = enclosed;
  }
  for (std::size_t i = 0; i < part.own.size(); ++i) {
    const std::size_t node = 4 * static_cast<std::size_t>(part.own[i]);
    std::copy_n(share.gradient.data() + 4 * i, 4, gradient + node);
    if (volume_gradient != nullptr) std::copy_n(share.volume_gradient.data() + 4 * i, 4, volume_gradient + node);
  }
}

void StepperWorkspace::returnLent() {
  if (spare) factor = std::move(spare);
}

std::shared_ptr<Factor> FactorShelf::find(std::uint64_t id) const {
  const std::lock_guard<std::mutex> lock(mutex_);
  const auto found = factors_.find(id);
  return found == factors_.end() ? nullptr : found->second.lock();
}

void FactorShelf::put(std::uint64_t id, const std::shared_ptr<Factor>& factor) {
  const std::lock_guard<std::mutex> lock(mutex_);
  for (auto i = factors_.begin(); i != factors_.end();) i = i->second.expired() ? factors_.erase(i) : std::next(i);
  factors_[id] = factor;
}

namespace {

// Spring at every node over the mean diagonal of the stiffness, so that a free body can be factored without inertia.
// Design choice: the rounding of single precision, in which the solution is stored [1].
constexpr double kShift = 1e-7;

// FNV-1a over 32-bit words
template <class Word>
void mix(std::uint64_t& hash, Word word) {
  static_assert(sizeof(Word) == sizeof(std::uint32_t));
  std::uint32_t bits = 0;
  std::memcpy(&bits, &word, sizeof bits);
  hash = (hash ^ bits) * 1099511628211ULL;
}

// 1: about rest, without couplings
std::uint64_t hashOf(const std::vector<float>& positions, const std::vector<StiffnessCoupling>& couplings) {
  if (positions.empty() && couplings.empty()) return 1;
  std::uint64_t hash = 1469598103934665603ULL;
  for (const float value : positions) mix(hash, value);
  for (const StiffnessCoupling& coupling : couplings) {
    for (const int node : coupling.node) mix(hash, node);
    for (const float value : coupling.weight) mix(hash, value);
    for (const float value : coupling.stiffness) mix(hash, value);
  }
  return hash;
}

void copyPositions(const MotionView& motion, int nodes, std::vector<float>& out) {
  out.resize(3 * static_cast<std::size_t>(nodes));
  for (int i = 0; i < nodes; ++i)
    for (int k = 0; k < 3; ++k) out[3 * static_cast<std::size_t>(i) + k] = static_cast<float>(motion.x[k][i]);
}

void addElements(const ElasticBody& body, const std::vector<float>& positions, double margin, BlockMatrix& matrix) {
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
}

void addSprings(const ElasticBody& body, double inertia, BlockMatrix& matrix) {
  const std::size_t n = body.rest.size();
  double mean = 0;
  for (std::size_t i = 0; i < n; ++i) mean += matrix.diagonal()[i].trace() / (3 * static_cast<double>(n));
  for (std::size_t i = 0; i < n; ++i) {
    double spring = inertia * body.mass[i] + kShift * mean;
    if (!body.foundation.empty()) spring += body.foundation[i];
    matrix.add(static_cast<int>(i), static_cast<int>(i), spring * Eigen::Matrix3d::Identity());
  }
}

}  // namespace

bool factorAt(const ElasticBody& body, const FactorPoint& point, double inertia, double margin,
              const std::shared_ptr<const FactorPlan>& plan, BlockMatrix& matrix, Factor& factor, ThreadPool& pool) {
  const std::vector<NodePair> pairs = coupledPairs(point.couplings, body.fixed, matrix.pattern());
  if (pairsOf(*factor.plan()) != pairs) factor.setPlan(coupledPlan(plan, pairs));
  matrix.couple(pairs);
  addElements(body, point.positions, margin, matrix);
  addSprings(body, inertia, matrix);
  addCouplings(point.couplings, body.fixed, matrix);
  for (std::size_t i = 0; i < body.rest.size(); ++i)
    if (body.fixed[i] != 0) matrix.fix(static_cast<int>(i));
  return factor.compute(matrix, pool);
}

bool factorAt(const ElasticBody& body, const std::vector<float>& positions, double inertia, double margin,
              BlockMatrix& matrix, Factor& factor) {
  ThreadPool single;
  return factorAt(body, {positions, {}}, inertia, margin, factor.plan(), matrix, factor, single);
}

void collectCouplings(const BodyLoads& loads, const double* positions4, double gain,
                      std::vector<StiffnessCoupling>& couplings) {
  couplings = loads.couplings;
  addThreadCouplings(loads, positions4, gain, couplings);
  if (loads.extra != nullptr) loads.extra->addStiffness(positions4, couplings);
}

void FactorSchedule::nameHere(const ElasticBody& body, const MotionView& motion, StepperMemory& memory) {
  copyPositions(motion, body.nodeCount(), memory.linearization_point);
  memory.couplings.clear();
  memory.linearization_id = hashOf(memory.linearization_point, memory.couplings);
  memory.next.clear();
  memory.next_couplings.clear();
}

void FactorSchedule::advance(const ElasticBody& body, const MotionView& motion, const BodyLoads& loads,
                             StepperMemory& memory, StepperWorkspace& scratch) const {
  if (memory.linearization_id == 0) memory.linearization_id = hashOf(memory.linearization_point, memory.couplings);
  if (!memory.next.empty() && memory.steps >= memory.due) {
    memory.linearization_point.swap(memory.next);
    memory.couplings.swap(memory.next_couplings);
    memory.linearization_id = memory.next_id;
    memory.next.clear();
    memory.next_couplings.clear();
  }
  if (steps == 0 || !memory.next.empty() || !farFrom(body, motion, memory.linearization_point)) return;
  copyPositions(motion, body.nodeCount(), memory.next);
  for (int i = 0; i < body.nodeCount(); ++i)
    for (int k = 0; k < 3; ++k) scratch.trial[4 * i + k] = motion.x[k][i];
  collectCouplings(loads, scratch.trial.data(), gain, memory.next_couplings);
  memory.next_id = hashOf(memory.next, memory.next_couplings);
  memory.due = memory.steps + steps;
}

// A matrix that is not positive definite gets another chance about rest.
void FactorSchedule::factorSafely(const ElasticBody& body, const FactorPoint& point,
                                  const std::shared_ptr<const FactorPlan>& plan, BlockMatrix& matrix, Factor& factor,
                                  ThreadPool& pool) const {
  if (factorAt(body, point, inertia, margin, plan, matrix, factor, pool)) return;
  if (factorAt(body, {{}, {}}, inertia, margin, plan, matrix, factor, pool)) return;
  throw Error("The stiffness of the body at rest is not positive definite; check its mesh, masses and materials.");
}

void FactorSchedule::provide(const ElasticBody& body, const BodyLoads& loads, const StepperMemory& memory,
                             StepperWorkspace& scratch) const {
  if (scratch.factor_id != memory.linearization_id) {
    if (scratch.making) scratch.making->finish();
    scratch.returnLent();
    if (scratch.next_id == memory.linearization_id) {
      scratch.factor.swap(scratch.next_factor);
      std::swap(scratch.columns, scratch.next_columns);
    } else if (std::shared_ptr<Factor> known = scratch.shelf->find(memory.linearization_id)) {
      scratch.spare = std::move(scratch.factor);
      scratch.factor = std::move(known);
      scratch.columns.reset();
    } else {
      factorSafely(body, {memory.linearization_point, memory.couplings}, scratch.plan, scratch.matrix, *scratch.factor,
                   *scratch.pool);
      scratch.columns.reset();
    }
    scratch.next_id = 0;
    scratch.factor_id = memory.linearization_id;
    scratch.schur.reset(*scratch.factor);
  }
  if (!memory.next.empty() && scratch.next_id != memory.next_id) makeInBackground(body, loads, memory, scratch);
  scratch.columns.setAttachments(*scratch.factor, loads.attachments);
}

std::shared_ptr<const Factor> FactorSchedule::share(const ElasticBody& body, const StepperMemory& memory,
                                                    StepperWorkspace& scratch) const {
  const std::uint64_t id = hashOf(memory.linearization_point, memory.couplings);
  if (std::shared_ptr<Factor> known = scratch.shelf->find(id)) return known;
  if (scratch.making) scratch.making->finish();  // it uses the matrix
  auto factor = std::make_shared<Factor>(scratch.plan, scratch.storage);
  factorSafely(body, {memory.linearization_point, memory.couplings}, scratch.plan, scratch.matrix, *factor,
               *scratch.pool);
  scratch.shelf->put(id, factor);
  return factor;
}

// With the columns of what is held and touched now, which most likely still is when the factor is used.
void FactorSchedule::makeInBackground(const ElasticBody& body, const BodyLoads& loads, const StepperMemory& memory,
                                      StepperWorkspace& scratch) const {
  if (!scratch.making) scratch.making = std::make_unique<BackgroundWorker>([&scratch] { makeNext(scratch); });
  scratch.making->finish();
  scratch.next_id = memory.next_id;
  FactorTask& task = scratch.task;
  task.schedule = this;
  task.body = &body;
  task.positions = memory.next;
  task.couplings = memory.next_couplings;
  loads.findNodes(task.nodes);
  task.attachments = loads.attachments;
  scratch.making->start();
}

void FactorSchedule::makeNext(StepperWorkspace& scratch) {
  const FactorTask& task = scratch.task;
  // made by the worker's thread, so that they have its priority and not that of the steps
  if (!scratch.making_pool) scratch.making_pool = std::make_unique<ThreadPool>(scratch.making_threads);
  task.schedule->factorSafely(*task.body, {task.positions, task.couplings}, scratch.plan, scratch.matrix,
                              *scratch.next_factor, *scratch.making_pool);
  scratch.next_columns.reset();
  scratch.next_columns.prepare(*scratch.next_factor, task.nodes, task.attachments);
}

bool FactorSchedule::farFrom(const ElasticBody& body, const MotionView& motion, const std::vector<float>& about) const {
  for (int i = 0; i < body.nodeCount(); ++i) {
    double distance2 = 0;
    for (int k = 0; k < 3; ++k) {
      const double from =
          about.empty() ? body.rest[i][k] : static_cast<double>(about[3 * static_cast<std::size_t>(i) + k]);
      distance2 += (motion.x[k][i] - from) * (motion.x[k][i] - from);
    }
    if (!(distance2 <= distance * distance)) return true;
  }
  return false;
}

}  // namespace vibe
