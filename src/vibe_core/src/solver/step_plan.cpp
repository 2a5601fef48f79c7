#include "solver/step_plan.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "vibe_core/solver/step_policy.hpp"

namespace vibe {

namespace {

// between two nodes of one element [m]
double shortestDistance(const ElasticBody& body) {
  double shortest2 = std::numeric_limits<double>::max();
  for (const auto& [nodes, size] : body.elements->nodeGroups())
    for (std::size_t first = 0; first < nodes->size(); first += static_cast<std::size_t>(size))
      for (int a = 0; a < size; ++a)
        for (int b = 0; b < a; ++b) {
          const int p = (*nodes)[first + a], q = (*nodes)[first + b];
          if (p >= 0 && q >= 0 && p != q) shortest2 = std::min(shortest2, (body.rest[p] - body.rest[q]).squaredNorm());
        }
  return std::sqrt(shortest2);
}

// 0: the factor stays
int factorSteps(const StepSettings& settings, const FactorPlan& plan) {
  if (!(settings.refactor_interval > 0)) return 0;
  const double interval = std::max(settings.refactor_interval, plan.operations / settings.factor_rate);
  return std::max(1, static_cast<int>(std::lround(interval / settings.step)));
}

FactorSchedule scheduleOf(const StepSettings& settings, const TimeScheme& scheme, const FactorPlan& plan) {
  FactorSchedule schedule;
  schedule.inertia = scheme.inertia;
  schedule.gain = scheme.z_gain / scheme.x_gain;
  schedule.margin = settings.iterations == 1 && !settings.backward_euler ? stepPolicy().margin_of_one : 1;
  schedule.steps = factorSteps(settings, plan);
  schedule.distance = settings.refactor_distance;
  return schedule;
}

StepSettings fallbackOf(StepSettings settings) {
  settings.backward_euler = true;
  return settings;
}

}  // namespace

StepPlan::StepPlan(ElasticBody body_of_steps, StepSettings settings_of_steps, FactorStorage storage_of_factors)
    : body(std::move(body_of_steps)),
      settings(settings_of_steps),
      pattern(std::make_shared<const BlockPattern>(blockPattern(body.nodeCount(), body.elements->nodeGroups()))),
      factor_plan(makeFactorPlan(*pattern)),
      scheme(settings, body.mass_damping, body.stiffness_damping),
      fallback_scheme(fallbackOf(settings), body.mass_damping, body.stiffness_damping),
      schedule(scheduleOf(settings, scheme, *factor_plan)),
      storage(storage_of_factors),
      free(body.foundation.empty() &&
           std::none_of(body.fixed.begin(), body.fixed.end(), [](char fixed) { return fixed != 0; })),
      safe_length(stepPolicy().safe_strain * shortestDistance(body)) {
  for (const Eigen::Vector3d& p : body.rest) size = std::max(size, (p - body.rest[0]).norm());
}

}  // namespace vibe
