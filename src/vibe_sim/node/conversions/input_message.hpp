#pragma once

#include <cstdint>

#include <vibe_msgs/TissuePull.h>
#include <vibe_msgs/TissuePullState.h>

#include "input/input_queue.hpp"
#include "vibe_core/state/state.hpp"

namespace vibe::sim {

/// A pull at the tissue, with its target in the frame world or stomach, which are the same.
/// @throws Error with one sentence if the message cannot be used
InputSample readPull(const vibe_msgs::TissuePull& message);

/// The pull spring after a step. Without a pull the particle is -1 and everything else is 0.
vibe_msgs::TissuePullState makePullState(const State& state, std::int64_t stamp);

}  // namespace vibe::sim
