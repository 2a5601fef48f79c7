#include "messages/event_lines.hpp"

#include <array>

namespace vibe::rviz_plugins {
namespace {

using Event = vibe_msgs::ProcedureEvent;

struct Kind {
  const char* title;
  EventSeverity severity;
};

// by number of kind
constexpr std::array<Kind, 32> kKinds = {{
    {"Grab", EventSeverity::Note},
    {"Grab missed", EventSeverity::Warning},
    {"Release", EventSeverity::Note},
    {"Slip", EventSeverity::Warning},
    {"Contact begins", EventSeverity::Note},
    {"Contact ends", EventSeverity::Note},
    {"Pressure reached", EventSeverity::Note},
    {"Warning", EventSeverity::Warning},
    {"Recovery", EventSeverity::Warning},
    {"Rejected", EventSeverity::Warning},
    {"Mark", EventSeverity::Note},
    {"Burn", EventSeverity::Warning},
    {"Deep burn", EventSeverity::Harm},
    {"Helix turned", EventSeverity::Note},
    {"Bite", EventSeverity::Success},
    {"Bite missed", EventSeverity::Warning},
    {"Bite withdrawn", EventSeverity::Warning},
    {"Needle exchanged", EventSeverity::Note},
    {"Mild bleeding", EventSeverity::Bleeding},
    {"Brisk bleeding", EventSeverity::Bleeding},
    {"Bleeding stopped", EventSeverity::Success},
    {"Bleeding overdue", EventSeverity::Bleeding},
    {"Technique", EventSeverity::Note},
    {"T-tag", EventSeverity::Note},
    {"Cinch pulls", EventSeverity::Note},
    {"Cinched", EventSeverity::Success},
    {"Cinch loose", EventSeverity::Warning},
    {"Tear-out", EventSeverity::Harm},
    {"Thread broke", EventSeverity::Harm},
    {"Phase", EventSeverity::Note},
    {"Pierced", EventSeverity::Note},
    {"Arm closed", EventSeverity::Note},
}};
static_assert(Event::ARM_CLOSED == kKinds.size() - 1);
static_assert(Event::REJECTED == 9 && Event::BITE == 14 && Event::BLEEDING_OVERDUE == 21 && Event::TEAR_OUT == 27);

}  // namespace

EventSeverity severityOf(std::uint8_t kind) {
  return kind < kKinds.size() ? kKinds[kind].severity : EventSeverity::Note;
}

std::string severityName(EventSeverity severity) {
  switch (severity) {
    case EventSeverity::Note:
      return "note";
    case EventSeverity::Success:
      return "success";
    case EventSeverity::Warning:
      return "warning";
    case EventSeverity::Bleeding:
      return "bleeding";
    case EventSeverity::Harm:
      return "harm";
  }
  return {};
}

bool isListed(const vibe_msgs::ProcedureEvent& event) {
  return event.kind != Event::CONTACT_BEGIN && event.kind != Event::CONTACT_END;
}

std::string eventText(const vibe_msgs::ProcedureEvent& event) {
  if (event.text.empty()) return std::string(event.kind < kKinds.size() ? kKinds[event.kind].title : "Event") + ".";
  return event.kind == Event::REJECTED ? "Rejected: " + event.text : event.text;
}

}  // namespace vibe::rviz_plugins
