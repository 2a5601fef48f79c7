#pragma once
#include "trainee/operator.hpp"

namespace vibe {

/// Moves the scope to joint positions past the walls: directly if they are near, else straightened and drawn back into
/// the entry, turned, and forward from there. Where it meets a wall with more than Skill::force_limit it comes back.
/// @return whether it arrived
bool travel(const TraineeHand::Joints& joints, Operator& me);

/// Straightens the scope and draws it back into the entry, out of what presses on it.
void retreat(Operator& me);

}  // namespace vibe
