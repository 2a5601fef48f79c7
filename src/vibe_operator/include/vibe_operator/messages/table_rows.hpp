#pragma once

#include <string>
#include <vector>

#include <vibe_msgs/ProcedureEvent.h>
#include <vibe_msgs/SutureArray.h>
#include <vibe_msgs/TraineeProgress.h>

namespace vibe::operating {

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

/// One set of bites as a row of a table.
struct SutureRow {
  std::string set;        ///< "1" for the first
  std::string bites;      ///< "7" that hold; "6 (-1)" with one that tore out
  std::string planned;    ///< "U"; a dash if no goal of a trainee planned it
  std::string technique;  ///< "U 83%" with the margin; a dash before the T-tag
  std::string printed;    ///< by the rule as printed: "U", "Z" or "other"; a dash before the T-tag
  std::string stage;      ///< "open", "tagged", "cinching", "cinched", "loose", "broken"
  std::string tension;    ///< maximum over all pieces now [N]
  bool warns = false;     ///< loose, broken, torn out, or recognised as another technique than planned
  std::string help;       ///< all of it in words
};

/// @param progress  of a trainee, which knows what was planned; null: none has come
std::vector<SutureRow> sutureRows(const vibe_msgs::SutureArray& sutures,
                                  const vibe_msgs::TraineeProgress* progress = nullptr);

/// Maximum tension of the pieces of a thread [N]; NaN without pieces or if the message contains NaN.
double maxTension(const vibe_msgs::Suture& suture);

}  // namespace vibe::operating
