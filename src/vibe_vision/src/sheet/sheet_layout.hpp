#pragma once

#include <string>
#include <vector>

#include <cairo.h>

#include "vibe_vision/sheet/marker_sheet.hpp"

namespace vibe::vision {

// Everything here in metres.
constexpr double kPageMargin = 15e-3;  // printers cannot print to the edge
constexpr double kTitleHeight = 16e-3;
constexpr double kRulerLength = 100e-3;
constexpr double kRulerBand = 12e-3;   // at the bottom and at the left
constexpr double kLabelHeight = 8e-3;  // above each marker
constexpr double kGap = 8e-3;          // around each marker, for arrows and ticks

/// Where everything goes. @throws Error if something is larger than a page
std::vector<SheetPage> layOut(const VisionConfig& config, const SheetOptions& options);

/// Draws the steps of a calibration with a picture on one page; one unit of the context is a metre.
/// @throws Error if they do not fit on the paper
void paintGuide(cairo_t* context, const SheetOptions& options, const std::vector<std::string>& instruments);

/// Draws a page on a cairo surface. @param units_per_metre  of the surface
void paintPage(cairo_surface_t* surface, double units_per_metre, const SheetOptions& options, const SheetPage& page,
               std::size_t number, std::size_t count);

}  // namespace vibe::vision
