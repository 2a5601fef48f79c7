#include "fem/static_path.hpp"

#include <algorithm>
#include <cmath>

namespace vibe::benchmarks {
namespace {

constexpr double kRelaxStep = 0.05;  // [s]
constexpr int kMaxRelaxSteps = 600;

bool floats(const ElasticBody& body) {
  return std::all_of(body.fixed.begin(), body.fixed.end(), [](char fixed) { return fixed == 0; });
}

}  // namespace

StaticPath::StaticPath(const CaseModel& model, double tolerance)
    : model_(model),
      tolerance_(tolerance),
      stepper_(std::make_unique<ImplicitStepper>(model.body(0), StepSettings{})),
      scratch_(stepper_->makeWorkspace()),
      guess_(stepper_->body()),
      motion_(stepper_->body()),
      loads_(model.loads(0)) {}

bool StaticPath::advanceTo(double level, int substeps) {
  bool converged = true;
  const double from = level_;
  for (int k = 1; k <= substeps; ++k) {
    level_ = from + (level - from) * k / substeps;
    if (model_.bodyDependsOnLevel()) {
      scratch_.reset();
      stepper_ = std::make_unique<ImplicitStepper>(model_.body(level_), StepSettings{});
      scratch_ = stepper_->makeWorkspace();
    }
    BodyLoads next = model_.loads(level_);
    if (next.gas.control == GasLoad::Control::Volume) next.gas.pressure = loads_.gas.pressure;
    loads_ = next;
    guess_.move(stepper_->body(), model_.prescribed(level_), motion_.view());
    if (floats(stepper_->body())) {
      converged = relax();
      continue;
    }
    const StepOutcome outcome = stepper_->settle(motion_.view(), loads_, *scratch_, tolerance_);
    converged = outcome.converged && outcome.finite;
  }
  return converged;
}

// A body held only by conditions has a singular stiffness. Long damped steps reach the same equilibrium, and the
// inertia makes the system regular.
bool StaticPath::relax() {
  StepSettings settings;
  settings.step = kRelaxStep;
  settings.backward_euler = true;
  settings.iterations = 30;
  settings.tolerance = 0.1 * tolerance_;
  const ImplicitStepper stepper(stepper_->body(), settings);
  const auto scratch = stepper.makeWorkspace();
  StepperMemory memory;
  stepper.refactor(motion_.view(), memory);
  for (int step = 0; step < kMaxRelaxSteps; ++step) {
    const BodyMotion before = motion_;
    if (!stepper.step(motion_.view(), loads_, memory, *scratch).finite) return false;
    double max = 0;
    for (std::size_t k = 0; k < 3; ++k)
      for (std::size_t n = 0; n < before.x[k].size(); ++n)
        max = std::max(max, std::abs(motion_.x[k][n] - before.x[k][n]));
    if (max < tolerance_) return true;
  }
  return false;
}

}  // namespace vibe::benchmarks
