#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "vibe_vision/calibrate/lens_calibration.hpp"
#include "vibe_vision/config/vision_config.hpp"

namespace vibe::vision {

/// Size of a page, upright: A4 is 210 x 297 mm, Letter 8.5 x 11 inches.
enum class Paper { A4, Letter };
struct PaperExtent {
  double width = 0, height = 0;  ///< [m]
};
PaperExtent extentOf(Paper paper);  ///< of an upright page

struct SheetOptions {
  Paper paper = Paper::A4;               ///< of all pages
  int copies = 3;                        ///< of each marker
  double paper_thickness = 1e-4;         ///< [m]; 80 g/m^2 office paper. Sleeves are shorter by pi times it
  double overlap = 2.5e-3;               ///< of a sleeve, glued under its other end [m]
  bool markers = true;                   ///< the pages with the markers of the configuration
  bool board = true;                     ///< the page with the chessboard
  bool guide = true;                     ///< the page that says how to calibrate, step by step
  BoardSpec board_spec;                  ///< for the chessboard
  std::string config_file = "rig.yaml";  ///< as the commands of the guide name it
};

/// A piece of a page, in metres from the page's upper left corner, x to the right and y down.
struct SheetItem {
  std::string name;     ///< of the instrument; empty for the chessboard
  MarkerDesign marker;  ///< of a chessboard: not used
  /// What is cut out: of a ring its square; of a sleeve `length` along x, u to the right, and one turn and the overlap
  /// along y, phi growing downwards from -pi; of a chessboard its black and white squares [m].
  double x = 0, y = 0, width = 0, height = 0;
};

struct SheetPage {
  std::vector<SheetItem> items;     ///< in the order in which they are drawn
  std::vector<std::string> guided;  ///< instruments whose calibration the page explains; empty: of no other page
};

/// A page as grey values, row by row: 0 black, 255 white.
struct SheetRaster {
  int width = 0, height = 0;        ///< [px]
  std::vector<std::uint8_t> value;  ///< width times height
};

/// Pages with all markers of a configuration at their true size, to be printed at 100 %: cut lines, names, the
/// direction of positive slide, and rulers of 100 mm along both sides that show a printer that scales; and a page that
/// says how to calibrate.
class MarkerSheet {
 public:
  /// @throws Error if something does not fit on the paper
  MarkerSheet(const VisionConfig& config, const SheetOptions& options);

  const std::vector<SheetPage>& pages() const { return pages_; }     ///< with markers first, chessboard, guide
  double width() const { return extentOf(options_.paper).width; }    ///< of the paper [m]
  double height() const { return extentOf(options_.paper).height; }  ///< [m]

  /// One file with all pages. @throws Error if it cannot be written
  void writePdf(const std::string& file) const;
  /// One file per page: FILE-1.svg, FILE-2.svg, ... beside `file`, which ends in ".svg"; `file` itself if there is one
  /// page only. @return the files. @throws Error
  std::vector<std::string> writeSvg(const std::string& file) const;
  /// A page as a printer of that resolution would print it.
  SheetRaster raster(std::size_t page, double pixels_per_metre) const;

 private:
  SheetOptions options_;
  std::vector<SheetPage> pages_;
};

/// Length of one turn of a sleeve on flat paper. Its printed side is at the design's diameter; the middle of the paper,
/// which does not stretch, is half the thickness further in. [m]
double flatTurn(const SleeveDesign& sleeve, double paper_thickness);
/// Diameter of the rod that the sleeve is made for: the design's diameter less the paper on both sides [m].
double rodDiameter(const SleeveDesign& sleeve, double paper_thickness);

}  // namespace vibe::vision
