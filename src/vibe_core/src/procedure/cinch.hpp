#pragma once
#include <vector>

#include "vibe_core/events/event.hpp"
#include "vibe_core/model/model.hpp"
#include "vibe_core/state/state.hpp"

namespace vibe {

// Both need scene.suture.

/// The button of the T-tag went down: the needle is dropped at the last bite.
void dropTTag(const Model& model, State& state, std::vector<Event>& events);

/// The cinch: begins to draw when its button goes down, draws while it is held, makes the set permanent when it is
/// let go.
void commandCinch(const Model& model, bool pressed, bool was_pressed, State& state, std::vector<Event>& events);

}  // namespace vibe
