#pragma once

#include <optional>

#include "contact/tool_motion.hpp"
#include "dynamics/implicit_workspace.hpp"
#include "dynamics/loss_limits.hpp"
#include "vibe_core/model/accounting.hpp"
#include "vibe_core/model/model.hpp"
#include "vibe_core/model/tissue_solver.hpp"
#include "vibe_core/solver/implicit_stepper.hpp"
#include "vibe_core/state/state.hpp"

namespace vibe {

/// One step of a scene: the constraint blocks add their loads, the stepper moves the tissue, the blocks store their
/// forces. Resting tissue is skipped; lost tissue is led back to rest.
class ImplicitStep {
 public:
  /// @param limits  that tell a lost state
  ImplicitStep(const Model& model, const ImplicitStepper& stepper, const LossLimits& limits, const ToolMotion* motion,
               bool insufflator_on, State& state, ImplicitWorkspace& scratch, StepReport& report);
  void run();

 private:
  Activity gather();
  void gatherSprings();
  ToolDisplacement expectedDisplacement() const;
  bool asleep(Activity activity) const;
  bool lost() const;
  bool heldByGas() const;
  void recover();
  bool solve();
  void yieldTool();
  void store();
  void keepToolApart();
  void reportTool();
  void reportHand(double tool_work);
  void reportImpedance();
  void correct();
  void account();
  Energies mechanicalEnergy() const;
  void updateRest(Activity activity);
  MotionView motionOf() const;

  const Model& model_;
  const ImplicitStepper& stepper_;
  const LossLimits& limits_;
  const ToolMotion* motion_;
  State& state_;
  StepReport& report_;
  ImplicitWorkspace& scratch_;
  std::optional<ShaftBend> bend_;           // of a tool that yields, in the middle of the step
  std::optional<ScopeSpringStep> springs_;  // of it
  ToolDisplacement expected_{};             // of it at the end of the step
  std::optional<ToolMotion> yielded_;       // its motion, after the solve
  StepContext context_;
  bool tool_stopped_ = false;  // by tissue, on its way
  StepWork work_;              // of the solve
  double contact_energy_ = 0;  // before it [J]
};

}  // namespace vibe
