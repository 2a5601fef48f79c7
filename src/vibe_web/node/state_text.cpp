#include "state_text.hpp"

#include <nlohmann/json.hpp>

#include "vibe_operator/messages/number_text.hpp"
#include "vibe_operator/messages/procedure_text.hpp"
#include "vibe_operator/messages/reference_values.hpp"
#include "vibe_operator/messages/table_rows.hpp"

namespace vibe::web {

using nlohmann::json;

namespace {

json measureText(const operating::ShownMeasure& measure, const operating::SessionMessages& session) {
  const double value = measure.value(session);
  const operating::Rating rating = operating::rate(measure, value, session.state.phase == "done");
  return {{"label", measure.label},
          {"unit", measure.unit},
          {"decimals", measure.decimals},
          {"value", value},
          {"range", operating::rangeText(measure)},
          {"rating", operating::ratingText(rating)},
          {"outside", rating == operating::Rating::Outside},
          {"explained", operating::explain(measure)}};
}

json setText(const operating::SutureRow& row) {
  return {{"set", row.set},     {"bites", row.bites},     {"technique", row.technique},
          {"stage", row.stage}, {"tension", row.tension}, {"warns", row.warns},
          {"help", row.help}};
}

}  // namespace

std::string dumped(const json& text) {
  return text.dump(-1, ' ', false, json::error_handler_t::replace);
}

std::string stateText(const vibe_msgs::ProcedureState& state, const vibe_msgs::SkillMetrics* skill,
                      const vibe_msgs::SutureArray* sutures) {
  json text = {{"scene", state.scene},
               {"time", state.time},
               {"paused", static_cast<bool>(state.paused)},
               {"phase", state.phase},
               {"tool", state.tool_state},
               {"held", state.held_particles},
               {"pressure", state.pressure},
               {"volume", state.volume},
               {"marks", skill != nullptr ? operating::marksText(*skill) : operating::kNoValue},
               {"bites", state.bites},
               {"sutures", state.sutures},
               {"cinched", state.sutures_cinched},
               {"bleeding", state.bleeding},
               {"blood", state.blood_lost},
               {"needle", !state.needle_loaded  ? "none"
                          : state.needle_on_arm ? "on the arm"
                                                : "in the exchange"},
               {"measures", json::array()},
               {"sets", json::array()}};
  if (skill != nullptr)
    for (const auto& measure : operating::measures())
      text["measures"].push_back(measureText(measure, {state, *skill, sutures}));
  if (sutures != nullptr)
    for (const auto& row : operating::sutureRows(*sutures)) text["sets"].push_back(setText(row));
  return dumped(text);
}

std::string replayText(const vibe_msgs::ReplayStatus& status) {
  json marks = json::array();
  for (std::size_t i = 0; i < status.marks.size() && i < status.mark_times.size(); ++i)
    marks.push_back({{"time", status.mark_times[i]}, {"text", status.marks[i]}});
  return dumped({{"file", status.file.substr(status.file.rfind('/') + 1)},
                 {"time", status.time},
                 {"duration", status.duration},
                 {"playing", static_cast<bool>(status.playing)},
                 {"rate", status.rate},
                 {"marks", marks},
                 {"difference", status.difference}});
}

void EventList::add(const vibe_msgs::ProcedureEvent& event) {
  if (!operating::isListed(event)) return;
  entries_.push_back({++last_, event.header.stamp.toSec(), operating::severityName(operating::severityOf(event.kind)),
                      operating::eventText(event), event.kind});
  if (entries_.size() > kKept) entries_.pop_front();
}

std::string EventList::text() const {
  json list = json::array();
  for (const Entry& entry : entries_)
    list.push_back({{"number", entry.number},
                    {"time", entry.time},
                    {"kind", entry.kind},
                    {"severity", entry.severity},
                    {"text", entry.text}});
  return dumped(list);
}

}  // namespace vibe::web
