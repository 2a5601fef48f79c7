#pragma once

#include <string>
#include <vector>

#include "vibe_vision/sheet/marker_sheet.hpp"

namespace vibe::vision {

/// One step of a calibration, for a person who does it the first time.
struct GuideStep {
  std::string title, what;
  std::string command;       ///< a line for a terminal
  std::string right, wrong;  ///< what it answers when all is well; what to do if it does not
};

/// The steps from a print to a checked calibration, in their order, with the commands for these instruments.
std::vector<GuideStep> guideSteps(const SheetOptions& options, const std::vector<std::string>& instruments);

}  // namespace vibe::vision
