#pragma once
#include <vector>

#include "vibe_sim/event.hpp"
#include "vibe_sim/model.hpp"
#include "vibe_sim/state.hpp"

namespace vibe {

/// The tissue helix between steps: takes hold of the wall when its button goes down with tissue in reach, lets go
/// when it goes up, slips when the force exceeds scene.helix->hold_force. Changes state.grip and state.helix_pressed.
/// What is held goes with the link that carries the helix: a corkscrew turns in the tissue and does not wind it up.
/// @param link_poses  of the tool's links in world; the origin of the helix link is the helix' tip
void updateGrip(const Model& model, const std::vector<Eigen::Isometry3d>& link_poses, bool pressed, State& state,
                std::vector<Event>& events);

/// Lets go and reports a slip if the force on the grip after a step is above what the helix holds.
void releaseOverloadedGrip(const Model& model, State& state, std::vector<Event>& events);

}  // namespace vibe
