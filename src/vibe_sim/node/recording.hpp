#pragma once
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "vibe_core/input/step_input.hpp"

namespace vibe {

/// What of a recorded session is needed to repeat it.
struct Recording {
  std::string scene;                            ///< text of the scene file
  std::vector<StepInput> inputs;                ///< of steps 0, 1, 2 ...
  std::map<std::uint64_t, std::string> hashes;  ///< of the state, by number of steps taken; 16 hex digits
  bool comparable = true;                       ///< false: of a release whose hashes cover other fields of the state
};

/// Reads the topics scene, applied_input and solver_statistics of a bag, also of older releases (StepInputReader).
/// @throws Error if the bag cannot be read, begins late, has gaps, or is of a version that this build does not read
Recording readRecording(const std::string& file);

}  // namespace vibe
