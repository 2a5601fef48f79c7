#pragma once
#include <memory>
#include <vector>

#include "fem/case_model.hpp"
#include "fem/tangent_guess.hpp"
#include "solver/implicit_stepper.hpp"

namespace vibe::benchmarks {

/// Follows the equilibria of a case from level to level.
class StaticPath {
 public:
  /// @param tolerance  bound on the remaining displacement of a node [m]
  StaticPath(const CaseModel& model, double tolerance);

  /// @returns false if the solve did not converge; the state is then the last iterate
  bool advanceTo(double level, int substeps);

  MotionView motion() { return motion_.view(); }
  const ElasticBody& body() const { return stepper_->body(); }
  const BodyLoads& loads() const { return loads_; }

 private:
  bool relax();

  const CaseModel& model_;
  double tolerance_, level_ = 0;
  std::unique_ptr<ImplicitStepper> stepper_;
  std::shared_ptr<StepperWorkspace> scratch_;
  TangentGuess guess_;
  BodyMotion motion_;
  BodyLoads loads_;
};

}  // namespace vibe::benchmarks
