#pragma once

#include <deque>
#include <string>

#include <vibe_msgs/ProcedureEvent.h>
#include <vibe_msgs/ProcedureState.h>
#include <vibe_msgs/ReplayStatus.h>
#include <vibe_msgs/SkillMetrics.h>
#include <vibe_msgs/SutureArray.h>
#include <nlohmann/json_fwd.hpp>

namespace vibe::web {

/// Texts of messages may hold any bytes. Numbers that are not finite become null.
std::string dumped(const nlohmann::json& text);

/// Message Kind::State as JSON: what the session says of itself, and the measures beside their published values with
/// the words of the panel of rviz. Numbers that are not defined are null.
/// @param skill, sutures  null: not come yet
std::string stateText(const vibe_msgs::ProcedureState& state, const vibe_msgs::SkillMetrics* skill,
                      const vibe_msgs::SutureArray* sutures);

/// Message Kind::Replay as JSON.
std::string replayText(const vibe_msgs::ReplayStatus& status);

/// The last events of a session, numbered from 1 on, so that a page knows those it has.
class EventList {
 public:
  void add(const vibe_msgs::ProcedureEvent& event);
  std::string text() const;  ///< message Kind::Events as JSON

 private:
  static constexpr std::size_t kKept = 60;
  struct Entry {
    std::size_t number;
    double time;
    std::string severity, text;
    int kind;
  };
  std::deque<Entry> entries_;
  std::size_t last_ = 0;
};

}  // namespace vibe::web
