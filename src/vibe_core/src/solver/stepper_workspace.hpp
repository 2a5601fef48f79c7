#pragma once

#include <memory>
#include <vector>

#include "solver/factor_schedule.hpp"
#include "solver/row_system.hpp"
#include "solver/shared_evaluation.hpp"
#include "vibe_core/clocks/step_stages.hpp"
#include "vibe_core/solver/implicit_stepper.hpp"
#include "vibe_core/threads/thread_pool.hpp"

namespace vibe {

/// What an evaluation of the energy has found at one point.
struct Evaluation {
  std::vector<float> displacement;      // of the point [m]
  std::vector<float> elastic_gradient;  // of elements, BodyLoads::stress and foundation [N]
  std::vector<float> extra_gradient;    // of BodyLoads::extra [N]
  std::vector<float> volume_gradient;   // [m^2]
  double elastic_value = 0;             // energy of elements and foundation [J]
  double stress_work = 0;               // of BodyLoads::stress from rest to there [J]
  double volume = 0, pressure = 0;      // [m^3], [Pa]
};

/// Where a solve is, and where it looks. Written by StepSolve, Potential and QuasiNewton; what is left when a solve has
/// ended is read once more by finishMotion(), and by the next solve of the same step.
struct Iterate {
  std::vector<double> z, z_hat;                 // unknown, where inertia wants it [m]
  std::vector<double> trial;                    // point along the direction [m]
  std::vector<float> gradient, trial_gradient;  // of the potential, at both [N]
  std::vector<float> direction, work;           // [m]
  std::vector<float> half;                      // half-solved vector, in elimination order
  Evaluation last, first, kept;                 // of a step; `kept`: at z, while a trial is evaluated
};

/// Pairs of moves and changes of the gradient (L-BFGS). Owned by QuasiNewton, for one solve.
struct PairHistory {
  static constexpr int kSize = RowUnknowns::kHistory;
  std::vector<std::vector<float>> move, change;
  std::vector<double> curvature;  // 1 / (move . change)
  int count = 0;
};

/// What the solves of one step hand on to each other. Begun by ImplicitStepper::begin().
struct Continuation {
  /// Where a solve starts: at a guess of its own, where an earlier solve of the step has ended, or at the guess of one
  /// that was abandoned before anything moved, whose evaluation is known.
  enum class From { Guess, Solution, Abandoned };
  From from = From::Guess;
  double elastic_energy = 0, usual_length = 0;  // of the memory before the step [J], [m]
  int evaluations = 0;                          // of the energy in the step so far
  double value = 0, foreseen = 0;               // of an abandoned solve: the potential [J], length of the motion [m]
  double motion_length = 0;  // by which the convergence of the last solve was judged; 0: it may not be continued [m]
};

/// All memory of an ImplicitStepper. Node vectors are 4 numbers per node.
class StepperWorkspace {
 public:
  StepperWorkspace(const std::vector<Eigen::Vector3d>& rest, std::shared_ptr<const FactorPlan> elements_plan,
                   FactorStorage storage, std::shared_ptr<const BlockPattern> pattern,
                   std::shared_ptr<FactorShelf> shelf);

  /// The next steps use a pool. The bits of results do not depend on it.
  /// @param shell  of the body; null: none
  void use(ThreadPool& threads, const ShellElements* shell);

  /// The contraction of the muscle in what is evaluated from now on. @param contraction  per node; null: none
  void contract(const std::vector<float>* contraction);

  // for as long as the workspace lives
  std::vector<double> rest;  // positions [m]; the fourth number is what displacements have there: less the contraction
  bool contracted = false;   // one of these is not 0
  FactorSlots factors;
  SharedEvaluation shared;
  ThreadPool single;
  ThreadPool* pool = &single;    // outlives what uses it
  StageClock* stages = nullptr;  // null: nothing is measured
  // for a step
  Continuation continuation;
  std::vector<double> moves;  // of the nodes over the step [m]
  double gas_stiffness = 0;   // at its end [Pa/m^3]
  // for a solve
  Iterate iterate;
  PairHistory history;
  RowSystem system;
};

}  // namespace vibe
