#pragma once

#include <optional>

#include "dynamics/implicit_workspace.hpp"
#include "dynamics/tissue_watch.hpp"
#include "dynamics/tool_step.hpp"
#include "vibe_core/model/accounting.hpp"

namespace vibe {

/// A step may be tried up to three times, each time with loads that know more. Each attempt begins at the state before
/// the step and solves for the motion of the tissue and the displacement of the tool.
enum class Attempt {
  First,        ///< contacts are looked for where the forces of the last step would bring the tool
  ToolReaimed,  ///< where the forces of the first attempt lead it
  ToolLimited   ///< the tool goes only as far as the wall has let it
};

/// What becomes of an attempt.
enum class AttemptResult {
  Accepted,   ///< walls and tool are on their sides: the step is stored
  ReaimTool,  ///< the forces lead the tool elsewhere than where its contacts were looked for
  LimitTool,  ///< the wall stops the tool before it is where the solve has it
  Unusable    ///< numbers that are not finite: the simulator starts again from rest
};

/// One step of a scene: the constraint blocks add their loads, the stepper moves the tissue, the blocks store their
/// forces. Resting tissue is skipped; lost tissue is led back to rest. docs/computation.md has a figure of the ways
/// that a step may take.
class ImplicitStep {
 public:
  /// @param limits  that tell a lost state
  /// @param motion  of the tool; null without one
  ImplicitStep(const Model& model, const ImplicitStepper& stepper, const LossLimits& limits, const ToolMotion* motion,
               bool insufflator_on, State& state, ImplicitWorkspace& scratch, StepReport& report);
  void run();

 private:
  Activity gather();
  void begin();
  AttemptResult tryStep(Attempt attempt);
  Attempt startAgain(AttemptResult failed);
  void prepareSolve();
  std::optional<AttemptResult> solve(Attempt attempt);
  void take(const StepOutcome& outcome);
  bool separate(Attempt attempt);
  bool isCorrected() const;
  void stopWall(double part);
  void recover();
  void store();
  void accountCorrections();
  void accountWorks();
  Energies mechanicalEnergy() const;

  const Model& model_;
  const ImplicitStepper& stepper_;
  State& state_;
  StepReport& report_;
  ImplicitWorkspace& scratch_;
  TissueWatch watch_;
  std::optional<ToolStep> tool_;  // empty without a tool
  StepContext context_;
  double follow_ = 0;          // to where a tool that misses is expected, over the way that it missed
  StepWork work_;              // of the last solve
  double contact_energy_ = 0;  // before it [J]
};

}  // namespace vibe
