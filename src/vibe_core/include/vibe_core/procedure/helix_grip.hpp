#pragma once
#include <vector>

#include "vibe_core/events/event.hpp"
#include "vibe_core/model/model.hpp"
#include "vibe_core/state/state.hpp"

namespace vibe {

/// The tissue helix between steps: takes hold of the wall when its button goes down with tissue in reach, lets go
/// when it goes up, slips when the force exceeds what it holds, see holdingForce(). Changes state.grip,
/// state.helix_pressed and in state.procedure where it took hold and, in a scene with a suture part, the phase.
/// What is held goes with the link that carries the helix: a corkscrew turns in the tissue and does not wind it up.
/// @param link_poses  of the tool's links in world; the origin of the helix link is the helix' tip
void updateGrip(const Model& model, const std::vector<Eigen::Isometry3d>& link_poses, bool pressed, State& state,
                std::vector<Event>& events);

/// What the helix holds after so many turns: initial_hold_force without any, growing in proportion to hold_force at
/// hold_turns (hold_turns 0: hold_force always) [N].
double holdingForce(const HelixScene& helix, double turns);

/// After a step: counts the turns since the helix took hold, and lets go and reports a slip if the force on the grip is
/// above what it holds. Turns count towards positive rotation, which screws a right-handed helix forward; the most
/// reached counts: turned back it keeps its hold until the button lets go.
void releaseOverloadedGrip(const Model& model, State& state, std::vector<Event>& events);

}  // namespace vibe
