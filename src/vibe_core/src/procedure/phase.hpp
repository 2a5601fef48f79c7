#pragma once

#include "vibe_core/events/event_log.hpp"
#include "vibe_core/model/model.hpp"
#include "vibe_core/state/state.hpp"

namespace vibe {

// The phase follows from the actions; no phase forbids a command:
//   Inspect  at the start, and when the scope is inserted again after Done
//   Mark     from the first use of the argon beam, except between T-tag and cinch
//   Suture   from the first grab of the helix or the first pierced wall; again when a set is finished
//   Pull     from the T-tag to the release of the cinch
//   Done     all sets are permanent, at least one is cinched, the arm is open, the helix holds nothing, and the scope
//   is
//            withdrawn to less than 1 cm

/// Enters a phase, with an Event::Kind::PhaseChanged unless it is the present one.
void enterPhase(Phase phase, State& state, EventLog log);

/// Call when the argon beam heats tissue.
void noteMarking(State& state, EventLog log);

/// Call when the helix has grabbed or the needle has pierced the wall.
void noteSuturing(State& state, EventLog log);

/// Enters Done, and Inspect after it, depending on the insertion of the scope.
void updatePhase(const Model& model, State& state, EventLog log);

}  // namespace vibe
