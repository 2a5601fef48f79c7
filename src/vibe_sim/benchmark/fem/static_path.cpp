#include "fem/static_path.hpp"

namespace vibe {

StaticPath::StaticPath(const CaseModel& model, double tolerance)
    : model_(model),
      tolerance_(tolerance),
      stepper_(std::make_unique<ImplicitStepper>(model.body(0), StepSettings{})),
      scratch_(stepper_->makeScratch()),
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
      scratch_ = stepper_->makeScratch();
    }
    BodyLoads next = model_.loads(level_);
    if (next.gas.control == GasLoad::Control::Volume) next.gas.pressure = loads_.gas.pressure;
    loads_ = next;
    guess_.move(stepper_->body(), model_.prescribed(level_), motion_.view());
    const StepOutcome outcome = stepper_->settle(motion_.view(), loads_, *scratch_, tolerance_);
    converged = outcome.converged && outcome.finite;
  }
  return converged;
}

}  // namespace vibe
