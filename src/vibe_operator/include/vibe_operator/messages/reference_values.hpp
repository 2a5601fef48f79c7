#pragma once
#include <vibe_msgs/ProcedureState.h>
#include <vibe_msgs/SkillMetrics.h>
#include <vibe_msgs/SutureArray.h>

#include <string>
#include <vector>

namespace vibe::operating {

/// What the measures of a session are taken from.
struct SessionMessages {
  const vibe_msgs::ProcedureState& state;  ///< of the simulator
  const vibe_msgs::SkillMetrics& skill;    ///< of the same session
  const vibe_msgs::SutureArray* sutures;   ///< null: not come yet
};

/// A measure as it is shown, with the published figures it can be held against, if there are any. Definitions of the
/// measures: docs/metrics.md.
struct ShownMeasure {
  std::string label;                                          ///< name of the measure, a few words
  std::string unit;                                           ///< of everything below; empty: a count
  int decimals = 0;                                           ///< of the value and its range
  double (*value)(const SessionMessages& session) = nullptr;  ///< NaN: not defined by what was done so far
  std::string meaning;                                        ///< one sentence
  std::string source;                                         ///< of the range; empty: none is published
  /// Range of the reference, in `unit`; either may be infinite; without a source of no meaning.
  double low = 0, high = 0;
  double bar_end = 1;  ///< the bar shows 0 to this, in `unit`
  bool grows = false;  ///< it rises as the session goes on: too little is no fault before the end
};

/// Measures in the order in which they are shown.
const std::vector<ShownMeasure>& measures();

/// How a value stands to its reference.
enum class Rating { NoReference, NoValue, NotYet, Within, Outside };

/// @param done  the procedure is done: what still grows has no excuse any more
Rating rate(const ShownMeasure& measure, double value, bool done);

/// "within the reference", for those who do not see colours.
std::string ratingText(Rating rating);

/// "6 to 9", "at most 5 N", "at least 34.6 %"; empty without a reference.
std::string rangeText(const ShownMeasure& measure);

/// Meaning, range and source, one below the other: the tool tip.
std::string explain(const ShownMeasure& measure);

/// Where to draw, as shares of the bar's length from 0 to 1.
struct BarShape {
  bool has_range = false, has_value = false;  ///< there is a reference, there is a number to show
  double range_begin = 0, range_end = 0;      ///< ends of the reference, clamped to the bar
  double value = 0;                           ///< clamped to the bar
  bool beyond = false;                        ///< the value lies outside the bar
};
/// @param value  in the unit of the measure; not finite: none
BarShape barShape(const ShownMeasure& measure, double value);

/// Force of tissue on the tool [N] that is published as seldom: the limit of "too hard".
extern const ShownMeasure kPullingForce;

}  // namespace vibe::operating
