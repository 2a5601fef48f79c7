#pragma once
#include <memory>
#include <string>
#include <vector>

#include "vibe_sim/event.hpp"
#include "vibe_sim/model.hpp"
#include "vibe_sim/progress.hpp"
#include "vibe_sim/scene/scene.hpp"
#include "vibe_sim/state.hpp"
#include "vibe_sim/step_input.hpp"
#include "vibe_sim/workspace.hpp"

namespace vibe {

/// Scene -> Model: everything that does not change while the simulation runs. Deterministic.
/// @param tool_urdf  text of the URDF that scene.scope names (the library does not know packages); unused without scope
/// @throws Error
std::shared_ptr<const Model> buildModel(const Scene& scene, const std::string& tool_urdf,
                                        const Progress& progress = {});

/// The part of buildModel() after the organ is there, for organs made in code: fills everything but model.scene and
/// model.organ, which the caller has set.
/// @throws Error
void finishModel(const std::string& tool_urdf, Model& model, const Progress& progress = {});

/// One sentence if the sub-steps are too long for the asked stiffness, empty if they are not.
std::string softnessWarning(const Model& model);

/// The state at time 0: rest shape, scope at the lower end of its range, gas at its initial pressure.
State initialState(const Model& model, std::uint64_t seed);

/// One step of model.scene.step_period: the whole simulator. No globals, no wall clock, no allocation beyond what
/// `workspace` and `events` keep. The result depends on model, state and input only, not on the thread count.
/// @param workspace  scratch memory, made once per thread of control by Workspace(model); carries nothing between steps
/// @param events     what happened is appended
void step(const Model& model, State& state, const StepInput& input, Workspace& workspace, std::vector<Event>& events);

/// FNV-1a, 64 bit, over everything in the state that influences the future.
std::uint64_t hash(const State& state);

}  // namespace vibe
