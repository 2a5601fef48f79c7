#pragma once
#include <Eigen/Geometry>
#include <vector>

#include "vibe_core/events/event_log.hpp"
#include "vibe_core/model/model.hpp"
#include "vibe_core/state/state.hpp"

namespace vibe {

/// Limit of the sets of a session. Design choice: the largest scenario of the ViBE paper has 14.
constexpr int kMaxSutures = 64;

// All need scene.suture and a tool.

/// Call in every step: the needle pierces the wall when the arm's joint reaches its closed end, and is withdrawn when
/// it reaches its open end.
void updateArm(const Model& model, const std::vector<Eigen::Isometry3d>& link_poses, State& state, EventLog log);

/// Call when the button of the anchor exchange is pressed: the needle changes sides or completes a bite, or the command
/// is rejected.
void exchangeNeedle(const Model& model, State& state, EventLog log);

}  // namespace vibe
