#pragma once
#include <vibe_msgs/ProcedureEvent.h>

#include <string>

namespace vibe::rviz_plugins {

/// How an event is shown. Every one has a symbol of its own, so that nothing depends on seeing colours.
enum class EventSeverity { Note, Success, Warning, Bleeding, Harm };

/// Kinds that are not known yet, from a newer simulator, are notes.
EventSeverity severityOf(std::uint8_t kind);

/// "warning": what the symbol means.
std::string severityName(EventSeverity severity);

/// False for touching and letting go, which come so often that they would push all else out of the list; what the tool
/// does now is told elsewhere.
bool isListed(const vibe_msgs::ProcedureEvent& event);

/// Its sentence, with "Rejected: " before it for a command that could not act. The title if there is no sentence.
std::string eventText(const vibe_msgs::ProcedureEvent& event);

}  // namespace vibe::rviz_plugins
