#pragma once
#include <vector>

#include "vibe_core/events/event.hpp"
#include "vibe_core/model/model.hpp"
#include "vibe_core/state/state.hpp"

namespace vibe {

/// Call before a step. The helix takes hold of the wall when its button is pressed with tissue in reach, and releases
/// it when the button is released. What is in reach is the point of the wall nearest to the tip; what is held, the disc
/// of the wall at rest around it (discWeights()), wherever its particles lie. Changes state.grip, state.helix_pressed,
/// the rotation at the grab in state.procedure and, in a scene with sutures, the phase. Held tissue moves with the link
/// that carries the helix, but does not turn with the helix: a corkscrew turns in the tissue.
/// @param link_poses  of the tool's links in world; the origin of the helix link is the tip of the helix
void updateGrip(const Model& model, const std::vector<Eigen::Isometry3d>& link_poses, bool pressed, State& state,
                EventLog log);

/// Force that the helix holds after a number of turns [N]: linear from initial_hold_force at 0 to hold_force at
/// hold_turns, constant above. With hold_turns 0 it is always hold_force.
double holdingForce(const HelixScene& helix, double turns);

/// Call after a step. Counts the turns since the helix took hold, and releases the tissue with a slip if the force on
/// the grip exceeds holdingForce(). Turns count in the direction of positive rotation, which drives a right-handed
/// helix forward. The maximum counts: a helix that is turned back keeps its hold until its button is released.
void releaseOverloadedGrip(const Model& model, State& state, EventLog log);

}  // namespace vibe
