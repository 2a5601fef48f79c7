#pragma once

#include <memory>

#include "vibe_sim/solver/elastic_body.hpp"
#include "vibe_sim/sparse/factor.hpp"

namespace vibe {

struct StepSettings {
  double step = 1.0 / 60;  ///< [s]
  /// Generalised-alpha (Chung, Hulbert 1993): the part of the amplitude of the fastest motions that one step keeps;
  /// 1: trapezoidal rule, conserves energy; 0: removes them in one step. [0, 1]
  double spectral_radius = 0.8;
  bool backward_euler = false;  ///< first order and strongly damping, for states far from any equilibrium
  int iterations = 3;           ///< quasi-Newton iterations a step may take
  double tolerance = 1e-7;      ///< a step ends earlier when no node would move farther than this [m]
};

/// What a step or a solve did.
struct StepOutcome {
  int iterations = 0;
  double last_move = 0;      ///< farthest a node moved in the last iteration [m]
  int refactorisations = 0;  ///< static solves only
  bool converged = false;    ///< last_move is below the tolerance
  bool finite = true;        ///< false: the state is not usable
};

/// The memory of a stepper: factors, histories, vectors. One per thread of control.
class StepperScratch;

/// Backward Euler or generalised-alpha steps, and static equilibria, by quasi-Newton iterations: L-BFGS (Nocedal 1980)
/// on top of the factor of a stiffness about an earlier state, with a line search on the energy.
/// Conditions, contacts and the gas enter by the exact block elimination (Woodbury) of their few unknowns in the
/// half-solved space, so they need no new factor.
class ImplicitStepper {
 public:
  ImplicitStepper(ElasticBody body, StepSettings settings, FactorStorage storage = FactorStorage::Half);
  ~ImplicitStepper();

  const ElasticBody& body() const { return body_; }
  const StepSettings& settings() const { return settings_; }

  /// A scratch whose factor is about the positions given; (3 * nodes) interleaved, null: about rest.
  std::unique_ptr<StepperScratch> makeScratch(const double* positions = nullptr) const;

  /// Makes the factor anew about these positions. Costs tens of step times.
  /// @returns false where the matrix was not positive definite (the old factor stays)
  bool refactor(const double* positions, StepperScratch& scratch) const;

  /// One step. Forces of the loads are their means over the step.
  StepOutcome step(MotionView motion, BodyLoads& loads, StepperScratch& scratch) const;

  /// The equilibrium under the loads from the positions in `motion` (velocities become 0), refactoring as it goes.
  /// @param tolerance  no node would move farther [m]
  StepOutcome settle(MotionView motion, BodyLoads& loads, StepperScratch& scratch, double tolerance,
                     int most_iterations = 400) const;

  /// Elastic energy at the positions [J].
  double elasticEnergy(const MotionView& motion, StepperScratch& scratch) const;

 private:
  struct Plan;
  ElasticBody body_;
  StepSettings settings_;
  std::unique_ptr<Plan> plan_;
};

}  // namespace vibe
