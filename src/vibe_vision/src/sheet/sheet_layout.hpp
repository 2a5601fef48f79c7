#pragma once
#include <vector>

#include "vibe_vision/sheet/marker_sheet.hpp"

namespace vibe::vision {

// Everything here in metres.
constexpr double kPageMargin = 15e-3;  // printers cannot print to the edge
constexpr double kTitleHeight = 16e-3;
constexpr double kRulerLength = 100e-3;
constexpr double kRulerBand = 12e-3;   // at the bottom and at the left
constexpr double kLabelHeight = 8e-3;  // above each marker
constexpr double kGap = 8e-3;          // around each marker, for arrows and ticks

struct PaperExtent {
  double width = 0, height = 0;
};
PaperExtent extentOf(Paper paper);

/// Where everything goes. @throws Error if something is larger than a page
std::vector<SheetPage> layOut(const VisionConfig& config, const SheetOptions& options);

}  // namespace vibe::vision
