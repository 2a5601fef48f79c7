#pragma once
#include <set>
#include <string>
#include <vector>

namespace vibe::sim {

/// How much of a topic a recording keeps. What a replay computes again is thinned or left out.
struct RecordingRule {
  std::string topic;  ///< without its namespace, or "type:PACKAGE/NAME" for all topics of a type
  double period;      ///< kept is one message in this time [s]; 0: all; kNever: none
  bool replayed;      ///< a replay writes all of its messages (replay --fill)
};

constexpr double kNever = -1;

/// Topics that no rule names are kept whole.
const std::vector<RecordingRule>& recordingRules();

/// The rule of a topic, or null. A rule with a name is for the topics of simulators alone: those of others are theirs.
/// @param topic     its whole name
/// @param type      of its messages; empty if it is not known
/// @param prefixes  namespaces of simulators, with a slash at the end
const RecordingRule* recordingRule(const std::string& topic, const std::string& type,
                                   const std::set<std::string>& prefixes);

/// Whether a topic's whole name is `name` in any namespace.
bool isTopic(const std::string& topic, const std::string& name);

}  // namespace vibe::sim
