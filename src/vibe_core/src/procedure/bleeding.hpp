#pragma once
#include <vector>

#include "vibe_core/events/event.hpp"
#include "vibe_core/model/model.hpp"
#include "vibe_core/state/state.hpp"

namespace vibe {

// Without scene.bleeding these do nothing and draw no random number.

/// Draws whether a bite just taken bleeds, and begins it. One draw per bite whatever comes of it, so that no bite's
/// outcome depends on the parameters' effect on the bites before.
void bleedFromBite(const Model& model, int suture, int bite, int particle, State& state, std::vector<Event>& events);

/// What a step of all bleedings adds up to; mild ones stop by themselves, brisk ones become overdue.
void updateBleedings(const Model& model, State& state, std::vector<Event>& events);

/// The cinch presses the walls of a set together: its bleedings stop.
void stopBleedings(int suture, State& state, std::vector<Event>& events);

/// A bite tore out of its set: later bites move up; what bleeds there goes on bleeding until the set is cinched.
void forgetBite(int suture, int bite, ProcedureState& procedure);

}  // namespace vibe
