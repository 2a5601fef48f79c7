#include "fem/static_path.hpp"

#include <algorithm>
#include <cmath>

#include "vibe_core/program/error.hpp"

namespace vibe::benchmarks {

TangentGuess::TangentGuess(const ElasticBody& body)
    : pattern_(std::make_shared<const BlockPattern>(blockPattern(body.nodeCount(), body.elements->nodeGroups()))),
      stiffness_(pattern_),
      factor_(makeFactorPlan(*pattern_), FactorStorage::Double) {}

void TangentGuess::move(const ElasticBody& body, const std::vector<std::pair<int, Eigen::Vector3d>>& places,
                        MotionView motion) {
  if (places.empty()) return;
  const std::size_t rows = 3 * body.rest.size();
  std::vector<double> displacement(rows), step(rows, 0.0), load(rows), answer(rows);
  for (std::size_t n = 0; n < body.rest.size(); ++n)
    for (int k = 0; k < 3; ++k) displacement[3 * n + k] = motion.x[k][n] - body.rest[n][k];
  for (const auto& place : places)
    for (int k = 0; k < 3; ++k) step[3 * place.first + k] = place.second[k] - motion.x[k][place.first];
  stiffness_.setZero();
  body.elements->addStiffness(displacement.data(), stiffness_);
  for (int n = 0; !body.foundation.empty() && n < body.nodeCount(); ++n)
    stiffness_.add(n, n, body.foundation[n] * Eigen::Matrix3d::Identity());
  stiffness_.multiply(step.data(), load.data());
  for (int n = 0; n < body.nodeCount(); ++n) {
    const bool fixed = body.fixed[n] != 0;
    for (int k = 0; k < 3; ++k) load[3 * n + k] = fixed ? step[3 * n + k] : -load[3 * n + k];
    if (fixed) stiffness_.fix(n);
  }
  if (!factor_.compute(stiffness_)) throw Error("static: the body can move without strain; clamp or hold more nodes.");
  factor_.solve(load.data(), answer.data());
  for (std::size_t n = 0; n < body.rest.size(); ++n)
    for (int k = 0; k < 3; ++k) motion.x[k][n] += answer[3 * n + k];
  for (const auto& place : places)
    for (int k = 0; k < 3; ++k) motion.x[k][place.first] = place.second[k];
}

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
