#include "solver/factor_schedule.hpp"

#include <algorithm>
#include <iterator>
#include <thread>
#include <utility>

#include "solver/couplings.hpp"
#include "vibe_core/files/fnv1a.hpp"
#include "vibe_core/program/error.hpp"
#include "vibe_core/solver/energy_term.hpp"
#include "vibe_core/tissue/shell.hpp"

namespace vibe {

FactorSlots::FactorSlots(std::shared_ptr<const FactorPlan> elements_plan, FactorStorage storage_of_factors,
                         std::shared_ptr<const BlockPattern> pattern, std::shared_ptr<FactorShelf> factors)
    : plan(std::move(elements_plan)),
      storage(storage_of_factors),
      shelf(std::move(factors)),
      current(std::make_shared<Factor>(plan, storage)),
      next(std::make_shared<Factor>(plan, storage)),
      matrix(std::move(pattern)) {}

FactorSlots::~FactorSlots() {
  making.reset();  // it works on the other members
}

void FactorSlots::returnLent() {
  if (own) current = std::move(own);
}

// As many as the steps have, where there are processors for them beside those of the steps.
void FactorSlots::share(int threads_of_steps) {
  if (making) making->finish();
  making_pool.reset();
  const int spare = static_cast<int>(std::thread::hardware_concurrency()) - threads_of_steps;
  making_threads = std::clamp(spare, 1, threads_of_steps);
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

// Spring at every node over the mean diagonal of the stiffness, so that a free body can be factored without inertia:
// the rounding of single precision, in which the solution is stored.
constexpr double kShift = 1e-7;

// 1: about rest, without couplings
std::uint64_t hashOf(const std::vector<float>& positions, const std::vector<StiffnessCoupling>& couplings) {
  if (positions.empty() && couplings.empty()) return 1;
  Fnv1a hash;
  hash.addWords(positions.data(), positions.size());
  for (const StiffnessCoupling& coupling : couplings) {
    hash.addWords(coupling.node.data(), coupling.node.size());
    hash.addWords(coupling.weight.data(), coupling.weight.size());
    hash.addWords(coupling.stiffness.data(), coupling.stiffness.size());
  }
  return hash.result();
}

// How far a driven body is carried about: that changes no stiffness [m].
Eigen::Vector3d carriedBy(const ElasticBody& body, const MotionView& motion, const BodyLoads& loads) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  if (!loads.driven) return sum;
  for (int i = 0; i < body.nodeCount(); ++i)
    for (int k = 0; k < 3; ++k) sum[k] += motion.x[k][i] - body.rest[i][k];
  return sum / body.nodeCount();
}

void copyPositions(const MotionView& motion, int nodes, const Eigen::Vector3d& carried,
                   const std::vector<float>* contraction, std::vector<float>& out) {
  out.resize(3 * static_cast<std::size_t>(nodes));
  for (int i = 0; i < nodes; ++i)
    for (int k = 0; k < 3; ++k)
      out[3 * static_cast<std::size_t>(i) + k] = static_cast<float>(motion.x[k][i] - carried[k]);
  if (contraction != nullptr) out.insert(out.end(), contraction->begin(), contraction->end());
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
  if (positions.size() > 3 * n)
    body.shell->addStiffness(displacement.data(), positions.data() + 3 * n, matrix);
  else
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
  copyPositions(motion, body.nodeCount(), Eigen::Vector3d::Zero(), nullptr, memory.linearization_point);
  memory.couplings.clear();
  memory.linearization_id = hashOf(memory.linearization_point, memory.couplings);
  memory.next.clear();
  memory.next_couplings.clear();
}

void FactorSchedule::advance(const ElasticBody& body, const MotionView& motion, const BodyLoads& loads,
                             StepperMemory& memory, FactorSlots& slots) const {
  if (memory.linearization_id == 0) memory.linearization_id = hashOf(memory.linearization_point, memory.couplings);
  if (!memory.next.empty() && memory.steps >= memory.due) {
    memory.linearization_point.swap(memory.next);
    memory.couplings.swap(memory.next_couplings);
    memory.linearization_id = memory.next_id;
    memory.next.clear();
    memory.next_couplings.clear();
  }
  if (steps == 0 || !memory.next.empty()) return;
  const Eigen::Vector3d carried = carriedBy(body, motion, loads);
  if (!farFrom(body, motion, carried, memory.linearization_point)) return;
  copyPositions(motion, body.nodeCount(), carried, loads.contraction, memory.next);
  // in double precision: the stiffness of a thread follows from the difference of two positions
  slots.positions.resize(4 * static_cast<std::size_t>(body.nodeCount()));
  for (int i = 0; i < body.nodeCount(); ++i)
    for (int k = 0; k < 3; ++k) slots.positions[4 * i + k] = motion.x[k][i];
  collectCouplings(loads, slots.positions.data(), gain, memory.next_couplings);
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

bool FactorSchedule::provide(const ElasticBody& body, const BodyLoads& loads, const StepperMemory& memory,
                             FactorSlots& slots, ThreadPool& pool) const {
  const bool another = slots.current_id != memory.linearization_id;
  if (another) takeCurrent(body, memory, slots, pool);
  if (!memory.next.empty() && slots.next_id != memory.next_id) makeInBackground(body, loads, memory, slots);
  slots.columns.setAttachments(*slots.current, loads.attachments);
  return another;
}

// From the background, from the shelf, or made now: after a snapshot neither may have it.
void FactorSchedule::takeCurrent(const ElasticBody& body, const StepperMemory& memory, FactorSlots& slots,
                                 ThreadPool& pool) const {
  if (slots.making) slots.making->finish();
  slots.returnLent();
  if (slots.next_id == memory.linearization_id) {
    slots.current.swap(slots.next);
    std::swap(slots.columns, slots.next_columns);
  } else if (std::shared_ptr<Factor> known = slots.shelf->find(memory.linearization_id)) {
    slots.own = std::move(slots.current);
    slots.current = std::move(known);
    slots.columns.reset();
  } else {
    factorSafely(body, {memory.linearization_point, memory.couplings}, slots.plan, slots.matrix, *slots.current, pool);
    slots.columns.reset();
  }
  slots.next_id = 0;
  slots.current_id = memory.linearization_id;
}

std::shared_ptr<const Factor> FactorSchedule::share(const ElasticBody& body, const StepperMemory& memory,
                                                    FactorSlots& slots, ThreadPool& pool) const {
  const std::uint64_t id = hashOf(memory.linearization_point, memory.couplings);
  if (std::shared_ptr<Factor> known = slots.shelf->find(id)) return known;
  if (slots.making) slots.making->finish();  // it uses the matrix
  auto factor = std::make_shared<Factor>(slots.plan, slots.storage);
  factorSafely(body, {memory.linearization_point, memory.couplings}, slots.plan, slots.matrix, *factor, pool);
  slots.shelf->put(id, factor);
  return factor;
}

// With the columns of what is held and touched now, which most likely still is when the factor is used.
void FactorSchedule::makeInBackground(const ElasticBody& body, const BodyLoads& loads, const StepperMemory& memory,
                                      FactorSlots& slots) const {
  if (!slots.making) slots.making = std::make_unique<BackgroundWorker>([&slots] { makeNext(slots); });
  slots.making->finish();
  slots.next_id = memory.next_id;
  FactorTask& task = slots.task;
  task.schedule = this;
  task.body = &body;
  task.positions = memory.next;
  task.couplings = memory.next_couplings;
  loads.findNodes(task.nodes);
  task.attachments = loads.attachments;
  slots.making->start();
}

void FactorSchedule::makeNext(FactorSlots& slots) {
  const FactorTask& task = slots.task;
  // made by the worker's thread, so that they have its priority and not that of the steps
  if (!slots.making_pool) slots.making_pool = std::make_unique<ThreadPool>(slots.making_threads);
  task.schedule->factorSafely(*task.body, {task.positions, task.couplings}, slots.plan, slots.matrix, *slots.next,
                              *slots.making_pool);
  slots.next_columns.reset();
  slots.next_columns.prepare(*slots.next, task.nodes, task.attachments);
}

bool FactorSchedule::farFrom(const ElasticBody& body, const MotionView& motion, const Eigen::Vector3d& carried,
                             const std::vector<float>& about) const {
  for (int i = 0; i < body.nodeCount(); ++i) {
    double distance2 = 0;
    for (int k = 0; k < 3; ++k) {
      const double from =
          about.empty() ? body.rest[i][k] : static_cast<double>(about[3 * static_cast<std::size_t>(i) + k]);
      const double away = motion.x[k][i] - carried[k] - from;
      distance2 += away * away;
    }
    if (!(distance2 <= distance * distance)) return true;
  }
  return false;
}

}  // namespace vibe
