#pragma once

#include "vibe_core/events/event_log.hpp"
#include "vibe_core/model/model.hpp"
#include "vibe_core/state/state.hpp"

namespace vibe {

// Without scene.bleeding, bleedFromBite() and updateBleedings() do nothing and draw no random number.

/// Decides at random whether a new bite bleeds, and starts the bleeding. There is exactly one draw per bite, so that
/// the outcome of a bite does not depend on the outcomes of earlier ones.
void bleedFromBite(const Model& model, int suture, int bite, int particle, State& state, EventLog log);

/// Advances all bleedings by one step: adds up the blood lost, stops mild ones after their duration, and reports brisk
/// ones that were not stopped in time.
void updateBleedings(const Model& model, State& state, EventLog log);

/// Stops the bleedings of a set, because the cinch presses its walls together.
void stopBleedings(int suture, State& state, EventLog log);

/// Call when a bite has torn out: renumbers the later bites of its set. Its bleeding continues until the set is
/// cinched.
void forgetBite(int suture, int bite, ProcedureState& procedure);

}  // namespace vibe
