#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <vector>

#include <Eigen/Core>

#include "solver/column_cache.hpp"
#include "threads/background_worker.hpp"
#include "vibe_core/solver/body_loads.hpp"
#include "vibe_core/solver/elastic_body.hpp"
#include "vibe_core/sparse/factor.hpp"
#include "vibe_core/state/stepper_memory.hpp"
#include "vibe_core/threads/thread_pool.hpp"

namespace vibe {

struct FactorSchedule;

/// What a factor is about.
struct FactorPoint {
  const std::vector<float>& positions;  ///< as StepperMemory::linearization_point
  const std::vector<StiffnessCoupling>& couplings;
};

/// inertia M + margin K + foundation + couplings, fixed nodes taken out.
/// @param plan    of the elements; the factor gets the one that belongs to the couplings
/// @param factor  its plan is kept if it is that of the couplings already
/// @param pool    shares the work
/// @returns false where that is not positive definite for rounding, as about a squashed state
bool factorAt(const ElasticBody& body, const FactorPoint& point, double inertia, double margin,
              const std::shared_ptr<const FactorPlan>& plan, BlockMatrix& matrix, Factor& factor, ThreadPool& pool);
/// The same without couplings, for a factor whose plan has none.
bool factorAt(const ElasticBody& body, const std::vector<float>& positions, double inertia, double margin,
              BlockMatrix& matrix, Factor& factor);

/// Stiffness that the loads add at positions (4 per node) [m].
/// @param gain  of the rows' values over positions, see setStepTargets(); 1 in an equilibrium
void collectCouplings(const BodyLoads& loads, const double* positions4, double gain,
                      std::vector<StiffnessCoupling>& couplings);

/// Factors that are kept for many workspaces, by what they are about. They are not changed any more.
class FactorShelf {
 public:
  std::shared_ptr<Factor> find(std::uint64_t id) const;
  void put(std::uint64_t id, const std::shared_ptr<Factor>& factor);

 private:
  mutable std::mutex mutex_;
  std::map<std::uint64_t, std::weak_ptr<Factor>> factors_;  // those that nobody keeps are gone
};

/// What the factor that is made in the background is to be about.
struct FactorTask {
  const FactorSchedule* schedule = nullptr;
  const ElasticBody* body = nullptr;
  std::vector<float> positions;  // as StepperMemory::linearization_point
  std::vector<StiffnessCoupling> couplings;
  std::vector<int> nodes;  // whose columns are prepared too
  RowList<AttachmentPoint> attachments;
};

/// The factors of a workspace: the one in use, and the next, which is made in the background. A cache: what they are
/// about is named by StepperMemory, and they are made again where they are not there. FactorSchedule owns them; others
/// read `current` and `columns`.
struct FactorSlots {
  FactorSlots(std::shared_ptr<const FactorPlan> elements_plan, FactorStorage storage_of_factors,
              std::shared_ptr<const BlockPattern> pattern, std::shared_ptr<FactorShelf> factors);
  ~FactorSlots();
  FactorSlots(const FactorSlots&) = delete;
  FactorSlots& operator=(const FactorSlots&) = delete;

  /// Afterwards `current` is the workspace's own, about anything.
  void returnLent();
  /// How many threads make the next factor, beside those of the steps.
  void share(int threads_of_steps);

  std::shared_ptr<const FactorPlan> plan;  // of the elements alone
  FactorStorage storage;
  std::shared_ptr<FactorShelf> shelf;
  std::shared_ptr<Factor> current, next;
  std::shared_ptr<Factor> own;                // while `current` is on the shelf; else null
  std::uint64_t current_id = 0, next_id = 0;  // what they are about; 0: nothing
  ColumnCache columns, next_columns;          // of `current`, of `next`
  BlockMatrix matrix;                         // of the factor that is being made
  std::vector<double> positions;              // (4 per node) at which the couplings of a factor are collected [m]
  FactorTask task;                            // of `next`
  std::unique_ptr<BackgroundWorker> making;   // of `next`; null: none was ever made
  int making_threads = 1;                     // that share it
  std::unique_ptr<ThreadPool> making_pool;    // these; null: there are none yet
};

/// Which factor a step uses is decided by the memory, a part of the state, so that a replay has the same bits; the
/// slots provide it, from the background if it is there already.
struct FactorSchedule {
  double inertia;   ///< [1/s^2]
  double margin;    ///< times the stiffness of the elements
  int steps;        ///< from the positions to the step that uses the factor about them; 0: it stays
  double distance;  ///< a node must have moved farther for another factor [m]
  double gain = 1;  ///< of the rows' values over positions, see setStepTargets()

  /// Lets the next factor take over where it is due, and names the positions and couplings of the one after.
  void advance(const ElasticBody& body, const MotionView& motion, const BodyLoads& loads, StepperMemory& memory,
               FactorSlots& slots) const;
  /// The factor that the memory names becomes the current one, with the columns of the attachment points about it.
  /// @returns whether it is another one than before
  bool provide(const ElasticBody& body, const BodyLoads& loads, const StepperMemory& memory, FactorSlots& slots,
               ThreadPool& pool) const;
  /// The factor that the memory names, on the shelf as long as somebody keeps it.
  std::shared_ptr<const Factor> share(const ElasticBody& body, const StepperMemory& memory, FactorSlots& slots,
                                      ThreadPool& pool) const;
  /// The present positions, without couplings, from this step on.
  static void nameHere(const ElasticBody& body, const MotionView& motion, StepperMemory& memory);

 private:
  bool farFrom(const ElasticBody& body, const MotionView& motion, const Eigen::Vector3d& carried,
               const std::vector<float>& about) const;
  void factorSafely(const ElasticBody& body, const FactorPoint& point, const std::shared_ptr<const FactorPlan>& plan,
                    BlockMatrix& matrix, Factor& factor, ThreadPool& pool) const;
  void takeCurrent(const ElasticBody& body, const StepperMemory& memory, FactorSlots& slots, ThreadPool& pool) const;
  void makeInBackground(const ElasticBody& body, const BodyLoads& loads, const StepperMemory& memory,
                        FactorSlots& slots) const;
  static void makeNext(FactorSlots& slots);
};

}  // namespace vibe
