#pragma once

#include <memory>

#include "solver/factor_schedule.hpp"
#include "solver/time_scheme.hpp"
#include "sparse/factor_plan.hpp"
#include "vibe_core/solver/implicit_stepper.hpp"

namespace vibe {

/// What the steps of a body have in common and nothing changes: the body, its schemes, when its factor is renewed.
struct StepPlan {
  StepPlan(ElasticBody body_of_steps, StepSettings settings_of_steps, FactorStorage storage_of_factors);

  /// A single iteration does not move far and starts from the inertial prediction. With more iterations, the error that
  /// the last step has left is small beside a large motion only, see StepSolve.
  bool extrapolates(bool fallback) const { return !fallback && settings.iterations == 1; }
  const TimeScheme& schemeOf(bool fallback) const { return fallback ? fallback_scheme : scheme; }

  ElasticBody body;
  StepSettings settings;
  std::shared_ptr<const BlockPattern> pattern;
  std::shared_ptr<const FactorPlan> factor_plan;
  TimeScheme scheme, fallback_scheme;  ///< of the settings; backward Euler
  FactorSchedule schedule;
  FactorStorage storage;
  std::shared_ptr<FactorShelf> shelf = std::make_shared<FactorShelf>();
  bool free;           ///< nothing holds the body
  double safe_length;  ///< of a move that is not verified [m]
  double size = 0;     ///< of the body [m]
};

}  // namespace vibe
