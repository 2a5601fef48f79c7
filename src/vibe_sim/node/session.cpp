#include "session.hpp"

#include "vibe_core/simulation/simulator.hpp"

namespace vibe {
namespace {

/// Inputs under which a state stays as it is until the next message.
StepInput holdingInput(const State& state) {
  StepInput input;
  input.joints = state.joints;
  input.buttons[HelixGrab] = state.helix_pressed ? 1 : 0;
  input.buttons[Cinch] = state.procedure.pressed[Cinch];  // released it would make the set permanent
  return input;
}

bool insufflatorIsOn(const Model& model, const StepInput& input) {
  return model.scene.gas && (model.scene.gas->insufflator_on || input.buttons[Insufflate] != 0);
}

}  // namespace

Session::Session(std::shared_ptr<const Model> new_model, std::uint64_t seed, std::int64_t origin, int thread_count)
    : model(std::move(new_model)),
      state(initialState(*model, seed)),
      workspace(std::make_unique<Workspace>(*model, thread_count)),
      recorder(*model, state),
      time(origin, model->scene.step_period),
      input(holdingInput(state)),
      threads(thread_count) {}

void Session::step() {
  events.clear();
  vibe::step(*model, state, input, *workspace, events);
  recorder.record(*model, state, insufflatorIsOn(*model, input), events);
}

void Session::replaceState(State new_state) {
  time.continueWith(state.step, new_state.step, model->scene.step_period);
  state = std::move(new_state);
  input = holdingInput(state);
  recorder.restart(*model, state);
  events.clear();
}

void Session::replaceModel(std::shared_ptr<const Model> new_model) {
  State new_state = initialState(*new_model, new_model->scene.seed);
  workspace = std::make_unique<Workspace>(*new_model, threads);
  recorder = MetricsRecorder(*new_model, new_state);
  model = std::move(new_model);
  ++revision;
  replaceState(std::move(new_state));
}

}  // namespace vibe
