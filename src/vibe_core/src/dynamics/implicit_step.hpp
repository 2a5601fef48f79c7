#pragma once

#include "contact/tool_motion.hpp"
#include "dynamics/implicit_scratch.hpp"
#include "solver/implicit_stepper.hpp"
#include "vibe_core/model/model.hpp"
#include "vibe_core/model/tissue_solver.hpp"
#include "vibe_core/state/state.hpp"

namespace vibe {

/// One step of a scene: the constraint blocks add their loads, the stepper moves the tissue, the blocks store their
/// forces. Resting tissue is skipped; lost tissue is led back to rest.
class ImplicitStep {
 public:
  /// @param absurd_energy  elastic energy above which the state counts as lost [J]
  ImplicitStep(const Model& model, const ImplicitStepper& stepper, double absurd_energy, const ToolMotion* motion,
               bool insufflator_on, State& state, ImplicitScratch& scratch, StepReport& report);
  void run();

 private:
  Activity gather();
  bool asleep(Activity activity) const;
  bool lost() const;
  void recover();
  bool solve();
  void store();
  void keepToolApart();
  void reportTool();
  void reportImpedance();
  void accountDamping();
  void updateRest(Activity activity);
  MotionView motionOf() const;

  const Model& model_;
  const ImplicitStepper& stepper_;
  double absurd_energy_;
  const ToolMotion* motion_;
  State& state_;
  StepReport& report_;
  ImplicitScratch& scratch_;
  StepContext context_;
};

}  // namespace vibe
