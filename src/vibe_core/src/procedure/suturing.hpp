#pragma once

#include <vector>

#include <Eigen/Geometry>

#include "vibe_core/events/event.hpp"
#include "vibe_core/model/model.hpp"
#include "vibe_core/procedure/stitch.hpp"
#include "vibe_core/solver/elastic_body.hpp"
#include "vibe_core/state/state.hpp"

namespace vibe {

/// The set of the present thread: the last one, unless it is permanent. Null: none.
Suture* activeSuture(ProcedureState& procedure);

/// Puts a new needle with a new thread on the arm.
void loadThread(ProcedureState& procedure);

/// Force of the thread on a bite: the sum of the tensions of the segments beside it, each along its segment [N].
Eigen::Vector3d forceOnBite(const Suture& suture, int bite, const State& state);

/// Force above which a bite tears out: scene.suture->pull_out_force times the share of the wall's thickness that the
/// bite goes through, at least a quarter and at most 1 [N].
double holdOfBite(const SutureScene& scene, const Bite& bite);

/// Call after a step. Thread that runs freely follows the tissue. Threads that pull break above their strength; bites
/// tear out above their hold, in each set at most one per step, the one with the highest ratio of force to hold.
void updateThreads(const Model& model, State& state, EventLog log);

/// Lengthens all threads until they have no tension, for tissue that was put back to rest.
void slackenThreads(const Model& model, State& state);

/// Limit of the sets of a session. Design choice: the largest scenario of the ViBE paper has 14.
constexpr int kMaxSutures = 64;

// All need scene.suture and a tool.

/// Call in every step: the needle pierces the wall when the arm's joint reaches its closed end, and is withdrawn when
/// it reaches its open end.
void updateArm(const Model& model, const std::vector<Eigen::Isometry3d>& link_poses, State& state, EventLog log);

/// Call when the button of the anchor exchange is pressed: the needle changes sides or completes a bite, or the command
/// is rejected.
void exchangeNeedle(const Model& model, State& state, EventLog log);

// Both need scene.suture.

/// Call when the button of the T-tag is pressed: drops the needle at the last bite, or rejects the command.
void dropTTag(const Model& model, State& state, EventLog log);

/// Call in every step. The cinch starts when its button is pressed, draws thread while the button is held, and makes
/// the set permanent when it is released.
void commandCinch(const Model& model, bool pressed, bool was_pressed, State& state, EventLog log);

}  // namespace vibe
