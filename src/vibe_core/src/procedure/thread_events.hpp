#pragma once
#include <vector>

#include "solver/elastic_body.hpp"
#include "vibe_core/events/event.hpp"
#include "vibe_core/model/model.hpp"
#include "vibe_core/state/state.hpp"

namespace vibe {

/// Shortest length of a segment, which the solver keeps between bites that have met. Drawing more out of a segment
/// would have no effect [m].
constexpr double kMinSegment = kMinThread;

/// The set of the present thread: the last one, unless it is permanent. Null: none.
Suture* activeSuture(ProcedureState& procedure);

/// Puts a new needle with a new thread on the arm.
void loadThread(ProcedureState& procedure);

/// Draws thread out of a set: out of the segment at the cinch until it is as short as kMinSegment, then out of the
/// next.
/// @param amount  [m]
/// @return amount drawn; less than `amount` if every segment is as short as it can be [m]
double drawThread(double amount, Suture& suture);

/// Tension at the cinch: the maximum over the segments from the cinch to the first one whose bites have not met (which
/// is longer than kMinSegment). The tissue cannot stretch a segment between bites that touch, so the tension of such a
/// segment alone does not show how hard the thread is drawn [N].
double cinchTension(const Suture& suture);

/// Force of the thread on a bite: the sum of the tensions of the segments beside it, each along its segment [N].
Eigen::Vector3d forceOnBite(const Suture& suture, int bite, const State& state);

/// Force above which a bite tears out: scene.suture->pull_out_force times the share of the wall's thickness that the
/// bite goes through, at least a quarter and at most 1 [N].
double holdOfBite(const SutureScene& scene, const Bite& bite);

/// Call after a step. Thread that runs freely follows the tissue. Threads that pull break above their strength; bites
/// tear out above their hold, in each set at most one per step, the one with the highest ratio of force to hold.
void updateThreads(const Model& model, State& state, std::vector<Event>& events);

/// Lengthens all threads until they have no tension, for tissue that was put back to rest.
void slackenThreads(const Model& model, State& state);

}  // namespace vibe
