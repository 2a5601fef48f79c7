#pragma once
#include <vibe_msgs/TissuePull.h>
#include <vibe_msgs/TissuePullState.h>

#include <cstdint>

#include "input_queue.hpp"
#include "vibe_core/state/state.hpp"

namespace vibe {

/// A pull at the tissue, with its target in the frame world or stomach, which are the same.
/// @throws Error with one sentence if the message cannot be used
InputSample readPull(const vibe_msgs::TissuePull& message);

/// The hand after a step; of one that has let go all is 0 but the particle, which is -1.
vibe_msgs::TissuePullState makePullState(const State& state, std::int64_t stamp);

}  // namespace vibe
