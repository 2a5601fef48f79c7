// vibe_marker_sheet: the markers of a configuration, a chessboard and how to calibrate with them, to be printed. No
// ROS.

#include <cstdio>
#include <filesystem>

#include "image_files.hpp"
#include "program_options.hpp"
#include "vibe_core/program/error.hpp"
#include "vibe_vision/sheet/marker_sheet.hpp"

namespace vision = vibe::vision;

namespace {

constexpr double kPreview = 300 / 25.4e-3;  // pixels per metre

struct Options {
  std::string config = "package://vibe_vision/config/rig.yaml";
  std::string pdf, svg, png;
  std::string paper = "a4";
  std::string board = "9x6";
  std::string square = "5 mm", thickness = "0.1 mm", overlap = "2.5 mm";
  int copies = 3;
  bool no_board = false, no_markers = false, no_guide = false;
};

void addOptions(vibe::OptionList& line, Options& options) {
  line.option("--config", options.config, "YAML file or package:// address").showDefault();
  line.option("--pdf", options.pdf, "Write all pages to this PDF file");
  line.option("--svg", options.svg, "Write SVG files, one per page: NAME-1.svg, NAME-2.svg, ...");
  line.option("--png", options.png, "Write previews of 300 dpi, one per page: NAME-1.png, NAME-2.png, ...");
  line.option("--paper", options.paper, "a4 or letter").showDefault().check(vibe::oneOf({"a4", "letter"}));
  line.option("--copies", options.copies, "Of each marker").showDefault().check(vibe::inRange(1, 50));
  line.option("--thickness", options.thickness, "Of the paper; sleeves are shorter by pi times it").showDefault();
  line.option("--overlap", options.overlap, "Of a sleeve, glued under its other end").showDefault();
  line.option("--board", options.board, "Inner corners of the chessboard").showDefault();
  line.option("--square", options.square, "Side of a square of the chessboard").showDefault();
  line.flag("--no-board", options.no_board, "No page with the chessboard");
  line.flag("--no-markers", options.no_markers, "No pages with markers");
  line.flag("--no-guide", options.no_guide, "No page with the steps of a calibration");
}

vision::SheetOptions sheetOptions(const Options& options) {
  vision::SheetOptions sheet;
  sheet.paper = options.paper == "a4" ? vision::Paper::A4 : vision::Paper::Letter;
  sheet.copies = options.copies;
  sheet.paper_thickness = vision::lengthOption("--thickness", options.thickness);
  sheet.overlap = vision::lengthOption("--overlap", options.overlap);
  sheet.markers = !options.no_markers;
  sheet.board = !options.no_board;
  sheet.guide = !options.no_guide;
  sheet.config_file = std::filesystem::path(options.config).filename();
  sheet.board_spec = vision::boardOption(options.board, options.square);
  return sheet;
}

void writePng(const vision::MarkerSheet& sheet, const std::string& file) {
  const std::string stem = file.size() > 4 ? file.substr(0, file.size() - 4) : "";
  if (stem + ".png" != file) throw vibe::Error(file + ": does not end in .png; give a file name that does");
  for (std::size_t i = 0; i < sheet.pages().size(); ++i) {
    vision::SheetRaster raster = sheet.raster(i, kPreview);
    const cv::Mat image(raster.height, raster.width, CV_8U, raster.value.data());
    const std::string name = stem + "-" + std::to_string(i + 1) + ".png";
    vision::writePicture(name, image, "The sheet");
    std::printf("%s\n", name.c_str());
  }
}

int run(const Options& options) {
  if (options.pdf.empty() && options.svg.empty() && options.png.empty()) {
    throw vibe::Error("nothing is written; give --pdf FILE, --svg FILE or --png FILE");
  }
  vision::VisionConfig config;
  if (!options.no_markers || !options.no_guide)
    config = vision::VisionConfig::load(options.config, vision::AxisRule::Optional);
  const vision::MarkerSheet sheet(config, sheetOptions(options));
  if (!options.pdf.empty()) {
    sheet.writePdf(options.pdf);
    std::printf("%s\n", options.pdf.c_str());
  }
  if (!options.svg.empty()) {
    for (const std::string& file : sheet.writeSvg(options.svg)) std::printf("%s\n", file.c_str());
  }
  if (!options.png.empty()) writePng(sheet, options.png);
  std::printf("Print at 100 %% and measure the rulers: both must be 100.0 mm.\n");
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  vibe::CommandLine line(
      "Writes the markers of a configuration, a chessboard and the steps of a calibration at their true size, to be "
      "printed.",
      "vibe_marker_sheet");
  Options options;
  addOptions(line, options);
  return vibe::runProgram(line, argc, argv, [&options] { return run(options); });
}
