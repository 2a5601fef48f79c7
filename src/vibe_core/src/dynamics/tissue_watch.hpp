#pragma once

#include "dynamics/implicit_workspace.hpp"
#include "dynamics/loss_limits.hpp"

namespace vibe {

struct Model;

/// Watches over tissue that needs no step, or that no step leads back: it sleeps while it rests, and is led straight to
/// rest where elasticity does not, because it is everted or burst, or because its folds are caught in each other.
class TissueWatch {
 public:
  TissueWatch(const Model& model, const ImplicitStepper& stepper, const LossLimits& limits, State& state,
              ImplicitWorkspace& scratch)
      : model_(model), stepper_(stepper), limits_(limits), state_(state), scratch_(scratch) {}

  /// The tissue rests, and nothing new acts on it.
  bool isAsleep(Activity activity) const;
  /// Begins a recovery where the tissue is lost or jammed.
  /// @returns whether it has begun in this step
  bool beginRecovery(bool insufflator_on);
  bool isRecovering() const { return state_.solver.recovery_steps > 0; }
  /// The nodes go a part of the way to rest and stop; a lost state has no meaningful dynamics.
  void leadToRest();
  /// Counts the steps in which the guard against crossings takes back what the wall's forces do.
  /// @param given  by the guard in this step [J]
  /// @param held   by the wall after it [J]
  void countJam(double given, double held);
  /// Counts the steps in which nothing moves.
  void countRest(Activity activity);

 private:
  bool isLost(bool insufflator_on) const;
  bool isJammed() const;
  bool isHeldByGas(const std::vector<float>& elastic_gradient) const;

  const Model& model_;
  const ImplicitStepper& stepper_;
  const LossLimits& limits_;
  State& state_;
  ImplicitWorkspace& scratch_;
};

}  // namespace vibe
