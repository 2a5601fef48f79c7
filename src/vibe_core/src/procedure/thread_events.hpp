#pragma once

#include "vibe_core/events/event_log.hpp"
#include "vibe_core/model/model.hpp"
#include "vibe_core/procedure/thread.hpp"
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

}  // namespace vibe
