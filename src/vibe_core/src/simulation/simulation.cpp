#include "vibe_core/simulation/simulation.hpp"

#include <utility>

#include "vibe_core/files/files.hpp"
#include "vibe_core/program/floating_point.hpp"
#include "vibe_core/scene/scene_parser.hpp"
#include "vibe_core/simulation/snapshot.hpp"
#include "vibe_core/simulation/tool_queries.hpp"

namespace vibe {
namespace {

StepInput holdingInput(const State& state) {
  StepInput input;
  input.joints = state.joints;
  input.buttons[HelixGrab] = state.helix_pressed ? 1 : 0;
  input.breath = state.motion.held ? Breath::Held : Breath::Free;
  input.buttons[Cinch] = state.procedure.pressed[Cinch];  // releasing it would make the set permanent
  return input;
}

}  // namespace

std::shared_ptr<const Model> loadModel(const std::string& address, const Progress& progress) {
  const Scene scene = loadScene(resolveAddress(address));
  const std::string urdf = scene.scope ? readTextFile(resolveAddress(scene.scope->urdf), "URDF") : "";
  return buildModel(scene, urdf, progress);
}

Simulation::Simulation(std::shared_ptr<const Model> model, const SimulationSettings& settings)
    : model_(std::move(model)),
      settings_(settings),
      state_(initialState(*model_, settings.seed.value_or(model_->scene.seed))),
      workspace_(workspaceFor(*model_, settings)),
      input_(holdingInput(state_)) {
  if (settings.metrics) recorder_.emplace(*model_, state_);
  if (settings.stages) stages_ = std::make_unique<StageSummary>();
  coverage_ = coverageFor(*model_);
  forgetSeen();
}

std::unique_ptr<WallCoverage> Simulation::coverageFor(const Model& model) const {
  const std::optional<InspectionScene>& inspection = model.scene.inspection;
  return settings_.metrics && inspection ? std::make_unique<WallCoverage>(model, *inspection) : nullptr;
}

void Simulation::forgetSeen() {
  if (!coverage_) return;
  coverage_->forget();
  recorder_->setCoverage(coverage_->shares());
}

std::unique_ptr<Workspace> Simulation::workspaceFor(const Model& model, const SimulationSettings& settings) {
  auto workspace = std::make_unique<Workspace>(model, settings.threads);
  if (settings.stages) workspace->measureStages();
  if (!settings.impedance) workspace->skipImpedance();
  return workspace;
}

const std::vector<Event>& Simulation::step(const StepInput& input) {
  setInput(input);
  return step();
}

const std::vector<Event>& Simulation::step() {
  checkFloatingPoint();
  events_.clear();
  timer_.start();
  vibe::step(*model_, state_, input_, *workspace_, events_);
  timer_.stop();
  if (stages_) stages_->add(workspace_->report());
  record(events_);
  return events_;
}

void Simulation::warmUp() {
  State state = state_;
  std::vector<Event> events;
  const StepReport before = workspace_->report();
  vibe::step(*model_, state, input_, *workspace_, events);
  workspace_->report() = before;
}

void Simulation::record(const std::vector<Event>& events) {
  if (!recorder_) return;
  recorder_->record(*model_, state_, insufflatorIsOn(*model_, input_), events);
  if (!coverage_ || !WallCoverage::isDue(state_.step, stepPeriod())) return;
  coverage_->look(tipPose(*model_, state_), {model_->organ.surface.triangles, state_.x, state_.y, state_.z}, time());
  recorder_->setCoverage(coverage_->shares());
}

void Simulation::run(std::int64_t steps, const InputSource& source, const Observer& observer) {
  for (std::int64_t k = 0; k < steps; ++k) {
    step(source(state_.time));
    if (observer) observer(*this);
  }
}

const SessionMetrics& Simulation::metrics() const {
  static const SessionMetrics kNone;
  return recorder_ ? recorder_->metrics() : kNone;
}

void Simulation::addWarnings(int count) {
  if (recorder_) recorder_->addWarnings(count);
}

std::uint64_t Simulation::hash() const {
  return vibe::hash(state_);
}

void Simulation::reset(std::optional<std::uint64_t> seed) {
  replaceState(initialState(*model_, seed.value_or(model_->scene.seed)));
}

const std::vector<WallContact>& Simulation::wallContacts() {
  if (!walls_) walls_ = std::make_unique<WallContacts>(*model_);
  return walls_->find(state_);
}

std::shared_ptr<const void> Simulation::prepare() {
  return model_->solver->prepare(state_, workspace_->solverWorkspace());
}

void Simulation::replaceState(State state) {
  state_ = std::move(state);
  input_ = holdingInput(state_);
  if (recorder_) recorder_->restart(*model_, state_);
  forgetSeen();
  forgetStep();
}

void Simulation::forgetStep() {
  events_.clear();
  workspace_->report().clear();
}

void Simulation::replaceModel(std::shared_ptr<const Model> model) {
  State state = initialState(*model, model->scene.seed);
  auto workspace = workspaceFor(*model, settings_);
  auto coverage = coverageFor(*model);
  if (recorder_) recorder_.emplace(*model, state);
  walls_.reset();
  coverage_ = std::move(coverage);
  workspace_ = std::move(workspace);  // before the model goes, which it refers to
  model_ = std::move(model);
  replaceState(std::move(state));
}

void Simulation::saveSnapshot(const std::string& file) const {
  vibe::saveSnapshot(*model_, state_, file);
}

void Simulation::loadSnapshot(const std::string& file) {
  replaceState(vibe::loadSnapshot(*model_, file));
}

}  // namespace vibe
