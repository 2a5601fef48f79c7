#pragma once
#include <vector>

#include "vibe_core/builder/model_builder.hpp"
#include "vibe_core/events/event.hpp"
#include "vibe_core/input/step_input.hpp"
#include "vibe_core/model/model.hpp"
#include "vibe_core/simulation/workspace.hpp"
#include "vibe_core/state/state.hpp"

namespace vibe {

/// One step of model.scene.step_period: the whole simulator. No globals, no wall clock, no allocation beyond what
/// `workspace` and `events` keep. The result depends on model, state and input only, not on the thread count.
/// @param workspace  scratch memory, made once per thread of control by Workspace(model); carries nothing between steps
/// @param events     what happened is appended
void step(const Model& model, State& state, const StepInput& input, Workspace& workspace, std::vector<Event>& events);

/// FNV-1a, 64 bit, over everything in the state that influences the future.
std::uint64_t hash(const State& state);

}  // namespace vibe
