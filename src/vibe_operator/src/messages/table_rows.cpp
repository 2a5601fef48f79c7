#include "vibe_operator/messages/table_rows.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <limits>

#include "vibe_operator/messages/number_text.hpp"

namespace vibe::operating {

namespace {

using Event = vibe_msgs::ProcedureEvent;

struct Kind {
  const char* title;
  EventSeverity severity;
};

// by number of kind
constexpr std::array<Kind, 34> kKinds = {{
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
    {"Blocked", EventSeverity::Warning},
    {"Left lumen", EventSeverity::Warning},
}};
static_assert(Event::LEFT_LUMEN == kKinds.size() - 1);
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

namespace {

std::string stageName(const vibe_msgs::Suture& suture) {
  switch (suture.stage) {
    case vibe_msgs::Suture::OPEN:
      return "open";
    case vibe_msgs::Suture::TAGGED:
      return "tagged";
    case vibe_msgs::Suture::CINCHING:
      return "cinching";
    case vibe_msgs::Suture::CINCHED:
      return suture.loose ? "loose" : "cinched";
    case vibe_msgs::Suture::BROKEN:
      return "broken";
    default:
      return "stage " + std::to_string(suture.stage);
  }
}

/// Patterns that are named by a letter (U, Z, C) are written in upper case.
std::string displayName(std::string name) {
  if (name.empty()) return kNoValue;
  if (name.size() == 1) name[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(name[0])));
  return name;
}

std::string techniqueText(const vibe_msgs::Suture& suture) {
  if (suture.technique_name.empty()) return kNoValue;
  return displayName(suture.technique_name) + " " + numberText(100 * suture.technique_margin, 0) + "%";
}

/// Pattern of the last goal that took bites into a suture; empty: none.
std::string plannedFor(std::size_t suture, const vibe_msgs::TraineeProgress* progress) {
  std::string pattern;
  if (!progress) return pattern;
  for (const vibe_msgs::GoalProgress& goal : progress->goals)
    if (goal.suture >= 0 && static_cast<std::size_t>(goal.suture) == suture) pattern = goal.pattern;
  return pattern;
}

std::string rulesText(const vibe_msgs::Suture& suture) {
  return "\nBy the corrected rule " + displayName(suture.corrected_technique_name) +
         ", by the rule as printed in the paper " + displayName(suture.printed_technique_name) + ".";
}

std::string helpOf(const SutureRow& row, const vibe_msgs::Suture& suture) {
  std::string text = "Set " + row.set + ", " + row.stage + ": " + countText(suture.bites.size(), "bite") + ", " +
                     std::to_string(suture.tear_outs) + " torn out. Maximum tension now " +
                     quantityText(maxTension(suture), 2, "N") + ".";
  if (!suture.technique_name.empty())
    text +=
        "\nTechnique " + row.technique + " is the margin to the next technique (100 %: certain)." + rulesText(suture);
  if (row.planned != kNoValue) text += "\nPlanned: " + row.planned + ".";
  if (suture.end > 0)
    text += "\nCinched with " + quantityText(suture.cinch_tension, 2, "N") + " after drawing " +
            quantityText(1e3 * suture.pulled, 0, "mm") + " of thread.";
  return text;
}

}  // namespace

double maxTension(const vibe_msgs::Suture& suture) {
  if (suture.tension.empty() ||
      !std::all_of(suture.tension.begin(), suture.tension.end(), [](double tension) { return std::isfinite(tension); }))
    return std::numeric_limits<double>::quiet_NaN();
  return *std::max_element(suture.tension.begin(), suture.tension.end());
}

std::vector<SutureRow> sutureRows(const vibe_msgs::SutureArray& sutures, const vibe_msgs::TraineeProgress* progress) {
  std::vector<SutureRow> rows;
  for (const vibe_msgs::Suture& suture : sutures.sutures) {
    SutureRow row;
    row.set = std::to_string(rows.size() + 1);
    row.bites = std::to_string(suture.bites.size());
    if (suture.tear_outs > 0) row.bites += " (-" + std::to_string(suture.tear_outs) + ")";
    const std::string planned = plannedFor(rows.size(), progress);
    row.planned = displayName(planned);
    row.technique = techniqueText(suture);
    row.printed = displayName(suture.printed_technique_name);
    row.stage = stageName(suture);
    row.tension = numberText(maxTension(suture), 1);
    const bool missed = !planned.empty() && !suture.technique_name.empty() && planned != suture.technique_name;
    row.warns = suture.tear_outs > 0 || suture.loose || missed || suture.stage == vibe_msgs::Suture::BROKEN;
    row.help = helpOf(row, suture);
    rows.push_back(std::move(row));
  }
  return rows;
}

}  // namespace vibe::operating
