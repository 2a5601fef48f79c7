#pragma once

#include "vibe_core/events/event_log.hpp"
#include "vibe_core/model/model.hpp"
#include "vibe_core/state/state.hpp"

namespace vibe {

// Both need scene.suture.

/// Call when the button of the T-tag is pressed: drops the needle at the last bite, or rejects the command.
void dropTTag(const Model& model, State& state, EventLog log);

/// Call in every step. The cinch starts when its button is pressed, draws thread while the button is held, and makes
/// the set permanent when it is released.
void commandCinch(const Model& model, bool pressed, bool was_pressed, State& state, EventLog log);

}  // namespace vibe
