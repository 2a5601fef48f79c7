#pragma once

#include <vector>

#include "solver/potential.hpp"
#include "solver/quasi_newton.hpp"
#include "solver/step_plan.hpp"
#include "solver/stepper_workspace.hpp"

namespace vibe {

/// One solve of a step, in two parts: foresee() finds the first direction, and with it the forces of contacts and where
/// the tool goes; then either finish() iterates and moves the body, or abandon() leaves it where it is, for a solve
/// with other loads. ImplicitStepper::begin() comes before the first solve of a step, beginAgain() before each further
/// one.
///
/// A solve starts at the present positions or, where the motion carries a node far, along the velocities: the step then
/// has to find only what changes it. Such a guess is given up where it has far more energy than the last step ended
/// with, or where the first direction leads back. A free body is moved rigidly first.
class StepSolve {
 public:
  /// @param motion   in and out, as at the start of the step
  /// @param scratch  of a stepper with this plan
  StepSolve(const StepPlan& plan, const MotionView& motion, BodyLoads& loads, StepperMemory& memory,
            StepperWorkspace& scratch);

  /// Nothing moves. Sets the forces of contacts and the displacement of the tool in the loads.
  void foresee();
  /// After foresee(): forces of the loads are their means over the step.
  StepOutcome finish();
  /// After foresee(): the next solve begins at the same guess, if that was of use, with its evaluation.
  /// @returns the evaluations of the energy that it took
  int abandon();

 private:
  double guess();
  double predict();
  void startFromHere();
  void evaluateStart();
  void doubtDirection();
  void judgeDriven();
  void chooseContacts();
  double foreseenVolume() const;
  int evaluationsLeft() const;
  void iterate(StepOutcome& outcome);
  void judgeEnd(bool done, StepOutcome& outcome);
  void correctStored(StepOutcome& outcome);

  const StepPlan& plan_;
  MotionView motion_;
  BodyLoads& loads_;
  StepperMemory& memory_;
  StepperWorkspace& scratch_;
  Iterate& at_;
  RowSystem& system_;
  Continuation& continuation_;
  const bool fallback_;  // backward Euler takes the place of the scheme
  const TimeScheme& scheme_;
  Potential potential_;
  QuasiNewton newton_;
  bool guessed_ = false;  // it starts elsewhere than at the present positions
  double change_ = 0;     // length of the first direction of a driven motion [m]
  bool goes_on_ = false;  // the motion is driven, and that length is short
  StepWays ways_;
};

/// Positions as node vectors (4 per node) [m].
void toPresent(const MotionView& motion, int nodes, std::vector<double>& z);
/// What the last solve found of the gas.
void storeGas(const StepperWorkspace& scratch, GasLoad& gas);

}  // namespace vibe
