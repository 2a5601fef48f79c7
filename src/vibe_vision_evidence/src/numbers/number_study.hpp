#pragma once

#include <functional>
#include <ostream>
#include <string>
#include <vector>

#include "bench/bench_cell.hpp"
#include "vibe_vision/track/tracker_policy.hpp"

namespace vibe::vision::evidence {

struct StudyOptions {
  int frames = 60;  ///< of each scene
  std::vector<std::string> scenes;
  std::vector<double> factors = {0.8, 1.2};
  std::vector<std::string> numbers;  ///< empty: all
};

/// What moves if one number of the tracker is shifted, over all scenes and both instruments, against the defaults.
struct NumberEffect {
  const TrackerNumber* number = nullptr;
  double factor = 1;
  double tracked = 0, search_found = 0, wrong = 0, phantom = 0, doubted = 0;  ///< frames more than with the defaults
  double error = 0;         ///< greatest change of an RMS along the axis, relative; of scenes with as many frames
  std::string error_where;  ///< scene and instrument of it
};

/// The scenes that a study shows by default: those of the benchmark and of its harder ones what makes a tracker decide.
std::vector<std::string> studyScenes();
/// Draws each scene once and tracks it with every number shifted.
/// @param progress  hears what is done. @throws Error for an unknown number or scene
std::vector<NumberEffect> studyNumbers(const StudyOptions& options, const std::function<void(std::string)>& progress);
/// CSV: a row per number and factor, with what the number is.
void writeEffects(std::ostream& out, const std::vector<NumberEffect>& effects);

}  // namespace vibe::vision::evidence
