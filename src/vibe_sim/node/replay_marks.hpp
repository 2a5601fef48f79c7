#pragma once
#include <string>
#include <vector>

#include "recording.hpp"

namespace vibe::sim {

/// A moment of a recording that is worth going to.
struct ReplayMark {
  double time = 0;   ///< since the start of the recording [s]
  std::string text;  ///< "phase suture", "bite"
};

/// Changes of phase, marks, bites, T-tags, cinches and mishaps, in order of time.
/// @throws Error if the bag cannot be read
std::vector<ReplayMark> readMarks(const Recording& recording);

}  // namespace vibe::sim
