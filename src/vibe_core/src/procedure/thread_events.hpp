#pragma once
#include <vector>

#include "solver/elastic_body.hpp"
#include "vibe_core/events/event.hpp"
#include "vibe_core/model/model.hpp"
#include "vibe_core/state/state.hpp"

namespace vibe {

/// Shortest length of a segment, and what the solver leaves between bites that have met: more drawn out of it would
/// pull nothing [m].
constexpr double kMinSegment = kMinThread;

/// The set that the present thread runs through: the last one, unless it is permanent. Null: none.
Suture* activeSuture(ProcedureState& procedure);

/// A new needle with its thread on the arm.
void loadThread(ProcedureState& procedure);

/// Draws thread out of a set: out of the segment at the cinch, and where that is down to kLeastSegment out of the next.
/// @param amount  [m]
/// @return what was drawn, less than `amount` where every segment is as short as it can be [m]
double drawThread(double amount, Suture& suture);

/// With which the device holds the thread: the tension of the segment that it draws from, which is beyond those whose
/// bites have met (kLeastSegment), and at least theirs. Where bites lie on each other the tissue pulls their segment
/// apart no more, so its own tension says nothing about what is drawn [N].
double cinchTension(const Suture& suture);

/// Force of the thread on a bite: the sum of the tensions of the segments beside it, each along its segment [N].
Eigen::Vector3d forceOnBite(const Suture& suture, int bite, const State& state);

/// The force above which a bite tears out: all of scene.suture->pull_out_force where the thread runs behind the whole
/// wall, less by the part of the wall that holds it, a quarter at least [N].
double holdOfBite(const SutureScene& scene, const Bite& bite);

/// After a step: thread that runs free follows the tissue; threads that pull break above their strength and tear out of
/// the wall, of each set at most one bite per step, the one that is most beyond its hold.
void updateThreads(const Model& model, State& state, std::vector<Event>& events);

/// All threads become as long as they need be to lie without tension; for tissue that was put back to rest.
void slackenThreads(State& state);

}  // namespace vibe
