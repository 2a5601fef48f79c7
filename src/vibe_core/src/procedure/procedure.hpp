#pragma once
#include <Eigen/Geometry>
#include <vector>

#include "vibe_core/events/event_log.hpp"
#include "vibe_core/input/step_input.hpp"
#include "vibe_core/model/model.hpp"
#include "vibe_core/state/state.hpp"

namespace vibe {

// The procedure as a deterministic state machine. Every pressed button and every closing of the needle arm either acts
// or emits one Event::Kind::Rejected with the reason. From every state a set can be finished.

/// Call before the tissue moves and after updateGrip(): applies the input to needle, exchange, T-tag and cinch, and
/// shortens the threads that are being drawn.
/// @param link_poses  of the tool's links in world at the start of the step
void commandProcedure(const Model& model, const std::vector<Eigen::Isometry3d>& link_poses, const StepInput& input,
                      State& state, EventLog log);

/// Call after the tissue has moved: breaks overloaded threads, tears out overloaded bites, updates bleeding and phase.
void updateProcedure(const Model& model, State& state, EventLog log);

}  // namespace vibe
