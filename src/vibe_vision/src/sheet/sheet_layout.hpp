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

struct PaperExtent {
  double width = 0, height = 0;
};
PaperExtent extentOf(Paper paper);

/// Where everything goes. @throws Error if something is larger than a page
std::vector<SheetPage> layOut(const VisionConfig& config, const SheetOptions& options);

/// Draws the steps of a calibration with a picture on one page; one unit of the context is a metre.
/// @throws Error if they do not fit on the paper
void paintGuide(cairo_t* context, const SheetOptions& options, const std::vector<std::string>& instruments);

/// Draws a page on a cairo surface.
class SheetPainter {
 public:
  /// @param units_per_metre  of the surface
  SheetPainter(cairo_surface_t* surface, double units_per_metre, const SheetOptions& options);
  ~SheetPainter();
  SheetPainter(const SheetPainter&) = delete;
  SheetPainter& operator=(const SheetPainter&) = delete;

  void paint(const SheetPage& page, std::size_t number, std::size_t count);

 private:
  cairo_t* context_;
  const SheetOptions& options_;

  void paintTitle(std::size_t number, std::size_t count);
  void paintRulers();
  void paintRuler(double x, double y, bool horizontal);
  void paintItem(const SheetItem& item);
  void paintRing(const SheetItem& item, const RingDesign& ring);
  void paintTag(const SheetItem& item, const TagDesign& tag);
  void paintSleeve(const SheetItem& item, const SleeveDesign& sleeve);
  void paintStripe(const SleeveDesign& sleeve, double from, double to);
  void paintSleeveHints(const SheetItem& item, const SleeveDesign& sleeve);
  void paintBoard(const SheetItem& item);
  void paintCutLine(const SheetItem& item);

  void line(double x0, double y0, double x1, double y1, double width, double grey);
  void arrow(double x0, double y0, double x1);
  void text(double x, double y, double size, const std::string& words);
};

}  // namespace vibe::vision
