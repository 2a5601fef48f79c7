#pragma once
#include <vibe_msgs/SutureArray.h>
#include <vibe_msgs/TraineeProgress.h>

#include <string>
#include <vector>

namespace vibe::rviz_plugins {

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

}  // namespace vibe::rviz_plugins
