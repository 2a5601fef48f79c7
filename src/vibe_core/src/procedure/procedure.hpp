#pragma once
#include <Eigen/Geometry>
#include <vector>

#include "vibe_core/events/event.hpp"
#include "vibe_core/input/step_input.hpp"
#include "vibe_core/model/model.hpp"
#include "vibe_core/state/state.hpp"

namespace vibe {

/// The procedure as a state machine, ROS-free and deterministic. Every button and every closing of the needle arm
/// either acts or leaves one Event::Kind::Refused with its reason; no state of it refuses everything.

/// Before the tissue moves: needle, exchange, T-tag, cinch and marking follow the input; lengths of threads that are
/// being drawn in become shorter. Call after updateGrip().
/// @param link_poses  of the tool's links in world at the start of the step
void commandProcedure(const Model& model, const std::vector<Eigen::Isometry3d>& link_poses, const StepInput& input,
                      State& state, std::vector<Event>& events);

/// After the tissue has moved, with the tensions of the step: threads that broke, bites that tore out, bleeding,
/// phases.
void updateProcedure(const Model& model, State& state, std::vector<Event>& events);

}  // namespace vibe
