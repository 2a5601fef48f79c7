#pragma once
#include <Eigen/Geometry>
#include <vector>

#include "vibe_core/events/event.hpp"
#include "vibe_core/model/model.hpp"
#include "vibe_core/state/state.hpp"

namespace vibe {

/// Most sets of a session: the paper's scenarios have 14.
constexpr int kMaxSutures = 64;

// All need scene.suture and a tool.

/// The arm's joint, which may have come to an end of its range: pierces when it closes, withdraws when it opens.
void updateArm(const Model& model, const std::vector<Eigen::Isometry3d>& link_poses, State& state,
               std::vector<Event>& events);

/// The button of the anchor exchange went down: the needle changes between arm and exchange, or a bite is complete.
void exchangeNeedle(const Model& model, State& state, std::vector<Event>& events);

}  // namespace vibe
