#pragma once
#include <string>
#include <vector>

#include "vibe_core/events/event.hpp"
#include "vibe_core/state/state.hpp"

namespace vibe {

void emitEvent(Event::Kind kind, double time, int particle, double value, std::string text, std::vector<Event>& events);

/// @param command  Button, or -1: the closing of the needle arm
void reject(int command, double time, std::string reason, std::vector<Event>& events);

/// "12.3 mm"; "1.25 N"; "0.6 ml".
std::string inMillimetres(double metres);
std::string inNewtons(double force);
std::string inMillilitres(double volume);

}  // namespace vibe
