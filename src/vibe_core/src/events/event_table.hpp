#pragma once
#include <vector>

#include "vibe_core/events/event.hpp"

namespace vibe {

/// What people read about a kind of event, or about a reason for a rejection.
///
/// A sentence contains fields in braces, {name} or {name:format}.
/// Numbers: value, limit, amount; formats: mm, N, ml, ml/min, mmHg, turns, bites, marks, sets, particles.
/// Words: set and bite (counted from 1), region, wall, technique and phase (of value), button (of value), spacing
/// (", 12.0 mm from the previous bite", nothing for the first bite of a set).
struct EventRow {
  Event::Kind kind;
  EventDetail detail;
  const char* name;      ///< the same in all rows of a kind
  const char* unit;      ///< of Event::value; empty: a count, a code or nothing
  const char* sentence;  ///< empty for Rejected: see ReasonRow
};

struct ReasonRow {
  RejectReason reason;
  const char* name;
  const char* sentence;
};

/// All kinds, in the order of their numbers; a kind with details has one row for each.
const std::vector<EventRow>& eventRows();

/// All reasons, in the order of their numbers.
const std::vector<ReasonRow>& reasonRows();

/// A sentence with its fields filled in. A field that does not exist shows as "?".
std::string fillIn(const char* sentence, const Event& event);

}  // namespace vibe
