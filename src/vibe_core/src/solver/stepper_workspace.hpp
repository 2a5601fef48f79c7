#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <vector>

#include "solver/constraint_rows.hpp"
#include "solver/constraint_schur.hpp"
#include "threads/background_worker.hpp"
#include "tissue/shell_part.hpp"
#include "vibe_core/clocks/step_stages.hpp"
#include "vibe_core/solver/implicit_stepper.hpp"
#include "vibe_core/threads/thread_pool.hpp"

namespace vibe {

struct FactorSchedule;
class ShellElements;

/// What the factor that is made in the background is to be about.
struct FactorTask {
  const FactorSchedule* schedule = nullptr;
  const ElasticBody* body = nullptr;
  std::vector<float> positions;  // (3 * nodes) [m]
  std::vector<StiffnessCoupling> couplings;
  std::vector<int> nodes;  // whose columns are prepared too
  RowList<AttachmentPoint> attachments;
};

/// What an evaluation of the energy has found at one point.
struct Evaluation {
  std::vector<float> displacement;      // of the point [m]
  std::vector<float> elastic_gradient;  // of elements and foundation [N]
  std::vector<float> extra_gradient;    // of BodyLoads::extra [N]
  std::vector<float> volume_gradient;   // [m^2]
  double elastic_value = 0;             // energy of elements and foundation [J]
  double volume = 0, pressure = 0;      // [m^3], [Pa]
};

/// The evaluation of a shell by several threads.
struct SharedEvaluation {
  struct Share {  // all but the first
    ShellPart part;
    std::vector<float> displacement, gradient, volume_gradient;  // of the part
  };
  int threads = 1;  // for which the shares are made
  std::vector<Share> shares;
  std::vector<double> value, volume;  // per piece [J], [m^3]

  /// With the bits of one piece after the other, where there are shares.
  /// @param gradient         (4 per node) zeros to add to [N]
  /// @param volume_gradient  the same [m^2]; null: volumes are not wanted, and are 0
  /// @returns the energy [J]
  double evaluate(const ShellElements& shell, ThreadPool& pool, const float* displacement, float* gradient,
                  float* volume_gradient);

 private:
  void evaluatePieces(const ShellElements& shell, int last, const float* displacement, float* gradient,
                      float* volume_gradient);
  void evaluateShare(const ShellElements& shell, Share& share, const float* displacement, float* gradient,
                     float* volume_gradient);
};

/// Factors that are kept for many workspaces, by what they are about. They are not changed any more.
class FactorShelf {
 public:
  std::shared_ptr<Factor> find(std::uint64_t id) const;
  void put(std::uint64_t id, const std::shared_ptr<Factor>& factor);

 private:
  mutable std::mutex mutex_;
  std::map<std::uint64_t, std::weak_ptr<Factor>> factors_;  // those that nobody keeps are gone
};

/// All memory of an ImplicitStepper. Node vectors are 4 numbers per node.
class StepperWorkspace {
 public:
  StepperWorkspace(const std::vector<Eigen::Vector3d>& rest, std::shared_ptr<const FactorPlan> elements_plan,
                   FactorStorage storage, std::shared_ptr<const BlockPattern> pattern,
                   std::shared_ptr<FactorShelf> factors);
  ~StepperWorkspace();

  /// The next steps use a pool. The bits of results do not depend on it.
  /// @param shell  of the body; null: none
  void use(ThreadPool& threads, const ShellElements* shell);
  /// Afterwards `factor` is the workspace's own, about anything.
  void returnLent();

  static constexpr int kHistory = RowUnknowns::kHistory;

  std::shared_ptr<const FactorPlan> plan;  // of the elements alone
  FactorStorage storage;
  std::shared_ptr<FactorShelf> shelf;
  std::shared_ptr<Factor> factor, next_factor;
  std::shared_ptr<Factor> spare;             // the own one, while `factor` is on the shelf; else null
  BlockMatrix matrix;                        // of the factor that is being made
  std::uint64_t factor_id = 0, next_id = 0;  // what they are about; 0: nothing
  FactorTask task;                           // of next_factor
  std::unique_ptr<BackgroundWorker> making;  // of next_factor; null: none was ever made
  int making_threads = 1;                    // that share it
  std::unique_ptr<ThreadPool> making_pool;   // these; null: there are none yet
  ColumnCache columns, next_columns;         // of `factor`, of `next_factor`
  ConstraintSchur schur;
  std::vector<double> rest;                     // positions [m]
  std::vector<double> z, z_hat;                 // unknown, where inertia wants it [m]
  std::vector<double> trial;                    // [m]
  std::vector<float> gradient, trial_gradient;  // [N]
  SharedEvaluation shared;
  Evaluation last, first, kept;                  // of a step; `kept`: at z, while a trial is evaluated
  std::vector<float> direction, work;            // [m]
  std::vector<float> half;                       // in elimination order
  std::vector<std::vector<float>> move, change;  // L-BFGS pairs
  std::vector<double> curvature;                 // 1 / (move . change)
  int spent = 0;                                 // evaluations of the energy in the step so far
  int pairs = 0;
  ConstraintRows rows;
  std::vector<std::pair<double, std::size_t>> contact_order;  // see limitContacts()
  Eigen::VectorXd target, rhs, force;
  RowUnknowns unknowns;
  Eigen::VectorXd row_moves;     // of the last direction, beyond what rows give way, to the scale of the rows [m]
  double gas_stiffness = 0;      // at the end of a step [Pa/m^3]
  StageClock* stages = nullptr;  // null: nothing is measured
  ThreadPool single;
  ThreadPool* pool = &single;                   // outlives what uses it
  double elastic_energy = 0, usual_length = 0;  // of the memory before the step [J], [m]
  bool solved = false;                          // z is that of an earlier solve of the step
  bool refused = false;                         // z and its evaluation are those of a refused solve of the step
  double value = 0, foreseen = 0;               // of that: the potential [J], length of the motion [m]
  double motion_length = 0;  // by which the convergence of that solve was judged; 0: it may not be continued [m]
};

/// What a factor is about.
struct FactorPoint {
  const std::vector<float>& positions;  ///< (3 * nodes) [m]; empty: rest
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

/// Which factor a step uses is decided by the memory, a part of the state, so that a replay has the same bits; the
/// scratch provides it, from the background if it is there already.
struct FactorSchedule {
  double inertia;   ///< [1/s^2]
  double margin;    ///< times the stiffness of the elements
  int steps;        ///< from the positions to the step that uses the factor about them; 0: it stays
  double distance;  ///< a node must have moved farther for another factor [m]
  double gain = 1;  ///< of the rows' values over positions, see setStepTargets()

  /// Lets the next factor take over where it is due, and names the positions and couplings of the one after.
  void advance(const ElasticBody& body, const MotionView& motion, const BodyLoads& loads, StepperMemory& memory,
               StepperWorkspace& scratch) const;
  /// The factor that the memory names, and the columns of the spots about it.
  void provide(const ElasticBody& body, const BodyLoads& loads, const StepperMemory& memory,
               StepperWorkspace& scratch) const;
  /// The factor that the memory names, on the shelf as long as somebody keeps it.
  std::shared_ptr<const Factor> share(const ElasticBody& body, const StepperMemory& memory,
                                      StepperWorkspace& scratch) const;
  /// What StepperWorkspace::task says, in the background.
  static void makeNext(StepperWorkspace& scratch);
  /// The present positions, without couplings, from this step on.
  static void nameHere(const ElasticBody& body, const MotionView& motion, StepperMemory& memory);

 private:
  bool farFrom(const ElasticBody& body, const MotionView& motion, const std::vector<float>& about) const;
  void factorSafely(const ElasticBody& body, const FactorPoint& point, const std::shared_ptr<const FactorPlan>& plan,
                    BlockMatrix& matrix, Factor& factor, ThreadPool& pool) const;
  void makeInBackground(const ElasticBody& body, const BodyLoads& loads, const StepperMemory& memory,
                        StepperWorkspace& scratch) const;
};

/// Stiffness that the loads add at positions (4 per node) [m].
/// @param gain  of the rows' values over positions, see setStepTargets(); 1 in an equilibrium
void collectCouplings(const BodyLoads& loads, const double* positions4, double gain,
                      std::vector<StiffnessCoupling>& couplings);

}  // namespace vibe
