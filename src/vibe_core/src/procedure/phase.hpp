#pragma once
#include <vector>

#include "vibe_core/events/event.hpp"
#include "vibe_core/model/model.hpp"
#include "vibe_core/state/state.hpp"

namespace vibe {

// Phases follow from what is done and forbid nothing:
//   Inspect  at the start, and when the scope goes in again after Done
//   Mark     from when the argon beam is used, unless a thread is being pulled
//   Suture   from the first grab of the helix or the first pierced wall; again when a set is finished
//   Pull     from the T-tag to the release of the cinch
//   Done     all sets are permanent, at least one is cinched, the arm is open and holds nothing, and the scope is drawn
//            back to less than 1 cm

/// Enters a phase; an Event::Kind::PhaseChanged says so unless it is the present one.
void enterPhase(Phase phase, State& state, std::vector<Event>& events);

/// The argon beam is used.
void noteMarking(State& state, std::vector<Event>& events);

/// The helix has grabbed, or the needle has pierced.
void noteSuturing(State& state, std::vector<Event>& events);

/// Done, and Inspect after it, from how far the scope is in.
void updatePhase(const Model& model, State& state, std::vector<Event>& events);

}  // namespace vibe
