#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <vector>

#include "vibe_core/solver/elastic_body.hpp"
#include "vibe_core/solver/step_ways.hpp"
#include "vibe_core/sparse/factor.hpp"
#include "vibe_core/state/stepper_memory.hpp"

namespace vibe {

/// What the forces of a step did, and what became of it. A step from x to x' balances
///   M a_m + c M v_f + grad W(z) = sum of the other forces at z + r
/// at the point z, where a_m and v_f are the mean acceleration and velocity of the scheme, c is the mass damping and r
/// is what the iterations leave. Each force is multiplied by x' - x; the works of rows are in the loads.
///
/// The force of the elements f(s) . (x' - x) along the step, s from 0 at x to 1 at x', comes from the two points that
/// the step has evaluated in any case, its first and its last: a parabola through both forces, with the difference of
/// the energies as its integral. It gives the losses:
///   stiffness damping  f(z) - f(part),  part: of the step after which the forces act
///   scheme             f(part) - integral of f + M a_m . (x' - x) - change of the kinetic energy
struct StepWork {
  double gas = 0;           ///< done by the gas on the body [J]
  double extra = 0;         ///< done by BodyLoads::extra on the body [J]
  double mass_damping = 0;  ///< dissipated by mass damping [J]
  double viscous = 0;       ///< dissipated by stiffness damping [J]
  double numerical = 0;     ///< dissipated by the time scheme [J]
  double stored = 0;        ///< change of the energy of elements and foundation, as foreseen [J]
  double to_first = 0;      ///< the same from the start of the step to its first point of evaluation [J]
  double residual = 0;      ///< done by what the iterations left unbalanced [J]
};

/// What a step or a solve did.
struct StepOutcome {
  int iterations = 0;        ///< of the quasi-Newton method
  double last_move = 0;      ///< farthest a node moved in the last iteration [m]
  int refactorisations = 0;  ///< static solves only
  bool converged = false;    ///< last_move is below the tolerance
  bool fallback = false;     ///< backward Euler, because of the settings or because one of the last did not arrive
  bool arrived = true;       ///< false: the step ended because its work is limited; the next steps go on
  double residual = 0;  ///< how far the next iteration would have moved a node, or a contact or thread is violated [m]
  int evaluations = 0;  ///< of the energy and its gradient
  int solves = 0;       ///< with the factor
  bool finite = true;   ///< false: the state is not usable
  StepWays ways;        ///< those that were taken
  StepWork work;        ///< of a step
};

struct StepSettings {
  double step = 1.0 / 60;  ///< [s]
  /// Generalised-alpha (Chung, Hulbert 1993): the part of the amplitude of the fastest motions that one step keeps;
  /// 1: trapezoidal rule, conserves energy; 0: removes them in one step. [0, 1]
  double spectral_radius = 0.2;
  bool backward_euler = false;  ///< first order and strongly damping, for states far from any equilibrium
  /// Quasi-Newton iterations of a step; one where the loads are BodyLoads::driven and little changes. It takes more
  /// while they do not halve what is left, or until nothing moves if the loads are BodyLoads::held_still, up to a
  /// number of further evaluations of the energy (kSpareEvaluations, kSpareInFallback); what remains then is left to
  /// the next steps, which start from the true forces.
  int iterations = 3;
  double tolerance = 1e-7;  ///< a step ends earlier when no node would move farther than this [m]
  /// A factor about other positions takes over this long after they were, and is made in the background meanwhile; a
  /// whole number of steps, so that a replay has the same bits. 0: the factor stays [s]
  double refactor_interval = 0.1;
  /// Operations per second that factors may take: the interval is longer where a factor needs more. Not clocked, for
  /// the same reason [1/s]
  double factor_rate = std::numeric_limits<double>::infinity();
  double refactor_distance = 5e-4;  ///< it is begun when a node has moved farther than this [m]
};

/// The memory of a stepper: factors, histories, vectors. One per thread of control.
class StepperWorkspace;
struct StepPlan;

/// Evaluations of the energy that a step may take beyond StepSettings::iterations. Design choice: eight, so that L-BFGS
/// with a history of six pairs shows its superlinear rate in a step that needs it.
constexpr int kSpareEvaluations = 8;
/// The same of a step with backward Euler (StepSettings::backward_euler, or because one of the last steps did not
/// arrive). Design choice: a step from far away spends half of its evaluations on line searches.
constexpr int kSpareInFallback = 16;

/// Backward Euler or generalised-alpha steps, and static equilibria, by quasi-Newton iterations: L-BFGS (Nocedal 1980)
/// on top of the factor of a stiffness about an earlier state, with a line search on the energy.
/// Conditions, contacts and the gas enter by the exact block elimination (Woodbury) of their few unknowns in the
/// half-solved space, so they need no new factor.
class ImplicitStepper {
 public:
  /// Orders the equations, see makeFactorPlan(); the first factor is made when a step needs it.
  /// @param storage  precision in which factors are kept
  ImplicitStepper(ElasticBody body, StepSettings settings, FactorStorage storage = FactorStorage::Half);
  ~ImplicitStepper();

  const ElasticBody& body() const;       ///< as constructed
  const StepSettings& settings() const;  ///< as constructed

  /// Memory for one thread of control. Workspaces of one stepper share the factors that they have, see shareFactor().
  std::shared_ptr<StepperWorkspace> makeWorkspace() const;

  /// The factor that a memory names. As long as the result lives, a workspace of this stepper that needs it, such as
  /// after a return to that memory, has it at once, with the same results. Costs tens of step times.
  std::shared_ptr<const Factor> shareFactor(const StepperMemory& memory, StepperWorkspace& scratch) const;

  /// Names the present positions as those that the factor is about, at once. Costs tens of step times.
  void refactor(const MotionView& motion, StepperMemory& memory) const;

  /// One step, by one solve. It starts along the velocities where these carry a node far, else from the positions. Its
  /// work is limited by counts: settings().iterations + kSpareEvaluations evaluations of the energy, or
  /// settings().iterations + kSpareInFallback with backward Euler, and at most two solves for each. A step that does
  /// not arrive ends at the best point it has found, with the mean velocity over the step, and the next few steps take
  /// backward Euler. Forces of the loads are their means over the step.
  StepOutcome step(MotionView motion, BodyLoads& loads, StepperMemory& memory, StepperWorkspace& scratch) const;

  /// A step of several solves, with other loads in each: begin(), a StepSolve, for each further one beginAgain(), with
  /// the motion as at the start of the step, and end(). All have the scheme that the step has begun with. A further
  /// solve starts where the one before has ended, if that arrived, or was abandoned. All together take as many
  /// evaluations as two without backward Euler may, but each has some at least.
  void begin(const MotionView& motion, const BodyLoads& loads, StepperMemory& memory, StepperWorkspace& scratch) const;
  void beginAgain(StepperMemory& memory, StepperWorkspace& scratch) const;  ///< see begin()
  /// After the last solve of a step that goes on: the rule after which the next steps take backward Euler.
  /// @param arrived  StepOutcome::arrived of that solve
  void end(bool arrived, StepperMemory& memory) const;
  const StepPlan& plan() const { return *plan_; }  ///< what all steps share

  /// The equilibrium under the loads from the positions in `motion` (velocities become 0), refactoring as it goes.
  /// @param tolerance  no node would move farther [m]
  StepOutcome settle(MotionView motion, BodyLoads& loads, StepperWorkspace& scratch, double tolerance,
                     int max_iterations = 400) const;

  /// Elastic energy at the positions, and its gradient.
  struct Elastic {
    double energy;                       ///< [J]
    const std::vector<float>& gradient;  ///< (4 per node), in the workspace until it is used again [N]
  };
  Elastic elastic(const MotionView& motion, StepperWorkspace& scratch) const;  ///< see Elastic

 private:
  std::unique_ptr<const StepPlan> plan_;
};

}  // namespace vibe
