#pragma once
#include <string>
#include <vector>

#include "vibe_core/builder/model_builder.hpp"
#include "vibe_core/events/event.hpp"
#include "vibe_core/input/step_input.hpp"
#include "vibe_core/model/model.hpp"
#include "vibe_core/simulation/workspace.hpp"
#include "vibe_core/state/state.hpp"

namespace vibe {

/// One step of model.scene.step_period: the whole simulator. Programs use class Simulation, which calls it. No globals,
/// no wall clock, no allocation beyond what `workspace` and `events` keep. The result depends on model, state and input
/// only, not on the thread count.
/// @param workspace  scratch memory, made once per thread of control by Workspace(model); carries nothing between steps
/// @param events     what happened is appended
void step(const Model& model, State& state, const StepInput& input, Workspace& workspace, std::vector<Event>& events);

/// The gas source of the scene, or the button, is on.
bool insufflatorIsOn(const Model& model, const StepInput& input);

/// XXH3 (Collet), 64 bit, over the list of the state's fields and the bits of all of them (state_fields.hpp): equal
/// hashes mean equal states of builds with the same fields. Not against forgery.
std::uint64_t hash(const State& state);

/// The same of an input and the number of the step that used it.
std::uint64_t hash(const StepInput& input, std::int64_t step);

/// The same of a text, such as a scene.
std::uint64_t hash(const std::string& text);

}  // namespace vibe
