#pragma once

#include "solver/step_plan.hpp"
#include "solver/stepper_workspace.hpp"

namespace vibe {

/// The equilibrium of a body under loads, by the iterations of a step without inertia. The factor is renewed where the
/// iteration is, every few iterations, since nothing bounds how far an equilibrium is from where it starts.
class StaticSolve {
 public:
  StaticSolve(const StepPlan& plan, BodyLoads& loads, StepperWorkspace& scratch)
      : plan_(plan), loads_(loads), scratch_(scratch) {}

  /// @param motion     in: positions at which it starts; out: the equilibrium, at rest
  /// @param tolerance  no node would move farther [m]
  StepOutcome run(const MotionView& motion, double tolerance, int max_iterations);

 private:
  void refactor();
  void placeAtRest(const MotionView& motion) const;

  const StepPlan& plan_;
  BodyLoads& loads_;
  StepperWorkspace& scratch_;
};

}  // namespace vibe
