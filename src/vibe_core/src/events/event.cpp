#include "vibe_core/events/event.hpp"

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstring>

#include "events/event_table.hpp"
#include "vibe_core/files/number_text.hpp"
#include "vibe_core/input/step_input.hpp"
#include "vibe_core/state/procedure_state.hpp"
#include "vibe_core/state/state.hpp"
#include "vibe_core/suture/technique.hpp"

namespace vibe {

namespace {

struct NumberFormat {
  const char* name;
  double scale;      // from SI
  const char* one;   // printf format for 1
  const char* many;  // and for all other numbers
};

constexpr double kPascalPerMmHg = 133.322;

constexpr std::array<NumberFormat, 10> kFormats = {{{"mm", 1e3, "%.1f mm", "%.1f mm"},
                                                    {"N", 1, "%.2f N", "%.2f N"},
                                                    {"ml", 1e6, "%.1f ml", "%.1f ml"},
                                                    {"ml/min", 60e6, "%.2f ml per minute", "%.2f ml per minute"},
                                                    {"mmHg", 1 / kPascalPerMmHg, "%.1f mmHg", "%.1f mmHg"},
                                                    {"turns", 1, "%.1f turns", "%.1f turns"},
                                                    {"bites", 1, "%.0f bite", "%.0f bites"},
                                                    {"marks", 1, "%.0f mark", "%.0f marks"},
                                                    {"sets", 1, "%.0f set", "%.0f sets"},
                                                    {"particles", 1, "%.0f particle", "%.0f particles"}}};

std::string numberText(double number, const std::string& format) {
  for (const NumberFormat& known : kFormats) {
    if (format != known.name) continue;
    return formatted(number == 1 ? known.one : known.many, number * known.scale);
  }
  return "?";
}

std::string spacingText(const Event& event) {
  return event.bite > 0 ? ", " + numberText(event.amount, "mm") + " from the previous bite" : "";
}

std::string buttonText(double value) {
  const bool known = value >= 0 && value < kButtonCount;
  return known ? kButtonNames[static_cast<std::size_t>(value)] : "?";
}

// By name; "?": there is no such field.
std::string fieldText(const std::string& name, const Event& event) {
  if (name == "set") return std::to_string(event.suture + 1);
  if (name == "bite") return std::to_string(event.bite + 1);
  if (name == "region") return toString(event.region);
  if (name == "wall") return toString(event.wall);
  if (name == "technique") return toString(static_cast<Technique>(static_cast<int>(event.value)));
  if (name == "phase") return toString(static_cast<Phase>(static_cast<int>(event.value)));
  if (name == "button") return buttonText(event.value);
  if (name == "spacing") return spacingText(event);
  const std::size_t colon = name.find(':');
  if (colon == std::string::npos) return "?";
  const std::string which = name.substr(0, colon), format = name.substr(colon + 1);
  if (which == "value") return numberText(event.value, format);
  if (which == "limit") return numberText(event.limit, format);
  return which == "amount" ? numberText(event.amount, format) : "?";
}

// Null: none.
const EventRow* rowOf(Event::Kind kind) {
  const auto& rows = eventRows();
  const auto found = std::find_if(rows.begin(), rows.end(), [&](const EventRow& row) { return row.kind == kind; });
  return found == rows.end() ? nullptr : &*found;
}

const ReasonRow* rowOf(RejectReason reason) {
  const auto& rows = reasonRows();
  const auto found = std::find_if(rows.begin(), rows.end(), [&](const ReasonRow& row) { return row.reason == reason; });
  return found == rows.end() ? nullptr : &*found;
}

}  // namespace

std::string fillIn(const char* sentence, const Event& event) {
  std::string text;
  for (const char* at = sentence; *at != '\0'; ++at) {
    const char* end = *at == '{' ? std::strchr(at, '}') : nullptr;
    if (end == nullptr) {
      text += *at;
      continue;
    }
    text += fieldText(std::string(at + 1, end), event);
    at = end;
  }
  return text;
}

const char* toString(Event::Kind kind) {
  const EventRow* row = rowOf(kind);
  return row != nullptr ? row->name : "unknown";
}

const char* toString(RejectReason reason) {
  const ReasonRow* row = rowOf(reason);
  return row != nullptr ? row->name : "unknown";
}

const char* unitOfValue(Event::Kind kind) {
  const EventRow* row = rowOf(kind);
  return row != nullptr ? row->unit : "";
}

std::string describe(const Event& event) {
  if (event.kind == Event::Kind::Rejected) {
    const ReasonRow* reason = rowOf(event.reason);
    return reason != nullptr ? fillIn(reason->sentence, event) : "";
  }
  for (const EventRow& row : eventRows())
    if (row.kind == event.kind && row.detail == event.detail) return fillIn(row.sentence, event);
  const EventRow* row = rowOf(event.kind);  // without its detail
  return row != nullptr ? std::string(row->name) + "." : "";
}

Event& EventLog::emit(Event::Kind kind, int particle, double value) const {
  Event& event = events_.emplace_back();
  event.kind = kind;
  event.time = state_.time;
  event.particle = particle;
  event.value = value;
  return event;
}

Event& EventLog::reject(int command, RejectReason reason) const {
  Event& event = emit(Event::Kind::Rejected, -1, command);
  event.reason = reason;
  return event;
}

}  // namespace vibe
