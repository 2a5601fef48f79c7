#pragma once

#include <memory>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "fem/case_model.hpp"
#include "vibe_core/solver/elastic_body.hpp"
#include "vibe_core/solver/implicit_stepper.hpp"
#include "vibe_core/sparse/factor.hpp"

namespace vibe::benchmarks {

/// Moves prescribed fixed nodes to new positions and all other nodes according to the tangent stiffness, so that a
/// solve starts near the equilibrium and not with one layer of crushed elements.
class TangentGuess {
 public:
  explicit TangentGuess(const ElasticBody& body);

  /// @param places  target positions of fixed nodes [m]
  void move(const ElasticBody& body, const std::vector<std::pair<int, Eigen::Vector3d>>& places, MotionView motion);

 private:
  std::shared_ptr<const BlockPattern> pattern_;
  BlockMatrix stiffness_;
  Factor factor_;
};

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
