#include "vibe_core/metrics/session_outcome.hpp"

#include <cstdio>

#include "vibe_core/metrics/run_summary.hpp"

namespace vibe {
namespace {

std::string quoted(const std::string& text) {
  std::string result = "\"";
  for (const char c : text) {
    char code[8];
    std::snprintf(code, sizeof code, "\\u%04x", static_cast<unsigned>(static_cast<unsigned char>(c)));
    const bool control = static_cast<unsigned char>(c) < 0x20;
    if (c == '"' || c == '\\') result += '\\';
    result += control ? std::string(code) : std::string(1, c);
  }
  return result + '"';
}

// 17 digits give back the same bits; JSON has no word for what is not a jsonNumber.
std::string jsonNumber(const std::optional<double>& value) {
  if (!value) return "null";
  char text[32];
  std::snprintf(text, sizeof text, "%.17g", *value);
  return text;
}

std::string measureLines(const std::vector<Measure>& measures) {
  std::string text;
  for (const Measure& m : measures)
    text += (text.empty() ? "\n    " : ",\n    ") + quoted(m.name) + ": {\"value\": " + jsonNumber(m.value) +
            ", \"unit\": " + quoted(m.unit) + "}";
  return text;
}

std::string eventLines(const EventCounts& events) {
  std::string text;
  for (int k = 0; k < kEventKindCount; ++k) {
    const auto kind = static_cast<Event::Kind>(k);
    text += (k == 0 ? "\n    " : ",\n    ") + quoted(toString(kind)) + ": " + std::to_string(events.of(kind));
  }
  return text;
}

std::string goalLines(const std::vector<GoalOutcome>& goals) {
  std::string text;
  for (const GoalOutcome& g : goals)
    text += (text.empty() ? "\n    " : ",\n    ") + std::string("{\"goal\": ") + quoted(g.goal) +
            ", \"reached\": " + (g.reached ? "true" : "false") + ", \"reason\": " + quoted(g.reason) + "}";
  return text;
}

}  // namespace

std::string toJson(const SessionOutcome& outcome) {
  return "{\n  \"measures\": {" + measureLines(outcome.measures) + "\n  },\n  \"events\": {" +
         eventLines(outcome.events) + "\n  },\n  \"goals\": [" + goalLines(outcome.goals) +
         "\n  ],\n  \"steps\": " + std::to_string(outcome.steps) + ",\n  \"state_hash\": \"" +
         toHex(outcome.state_hash) + "\"\n}\n";
}

}  // namespace vibe
