#include "messages/event_lines.hpp"

#include <array>

namespace vibe {
namespace {

using Event = vibe_msgs::ProcedureEvent;

struct Kind {
  const char* title;
  Severity severity;
};

// by number of kind
constexpr std::array<Kind, 32> kKinds = {{
    {"Grab", Severity::Note},
    {"Grab missed", Severity::Warning},
    {"Release", Severity::Note},
    {"Slip", Severity::Warning},
    {"Contact begins", Severity::Note},
    {"Contact ends", Severity::Note},
    {"Pressure reached", Severity::Note},
    {"Warning", Severity::Warning},
    {"Recovery", Severity::Warning},
    {"Rejected", Severity::Warning},
    {"Mark", Severity::Note},
    {"Burn", Severity::Warning},
    {"Deep burn", Severity::Harm},
    {"Helix turned", Severity::Note},
    {"Bite", Severity::Success},
    {"Bite missed", Severity::Warning},
    {"Bite withdrawn", Severity::Warning},
    {"Needle exchanged", Severity::Note},
    {"Mild bleeding", Severity::Bleeding},
    {"Brisk bleeding", Severity::Bleeding},
    {"Bleeding stopped", Severity::Success},
    {"Bleeding overdue", Severity::Bleeding},
    {"Technique", Severity::Note},
    {"T-tag", Severity::Note},
    {"Cinch pulls", Severity::Note},
    {"Cinched", Severity::Success},
    {"Cinch loose", Severity::Warning},
    {"Tear-out", Severity::Harm},
    {"Thread broke", Severity::Harm},
    {"Phase", Severity::Note},
    {"Pierced", Severity::Note},
    {"Arm closed", Severity::Note},
}};
static_assert(Event::ARM_CLOSED == kKinds.size() - 1);
static_assert(Event::REJECTED == 9 && Event::BITE == 14 && Event::BLEEDING_OVERDUE == 21 && Event::TEAR_OUT == 27);

}  // namespace

Severity severityOf(std::uint8_t kind) {
  return kind < kKinds.size() ? kKinds[kind].severity : Severity::Note;
}

std::string severityName(Severity severity) {
  switch (severity) {
    case Severity::Note:
      return "note";
    case Severity::Success:
      return "success";
    case Severity::Warning:
      return "warning";
    case Severity::Bleeding:
      return "bleeding";
    case Severity::Harm:
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

}  // namespace vibe
