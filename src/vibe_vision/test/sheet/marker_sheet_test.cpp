#include "vibe_vision/sheet/marker_sheet.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <cstdio>
#include <fstream>
#include <iterator>
#include <regex>
#include <string>

#include "sheet/guide_steps.hpp"
#include "vibe_core/program/error.hpp"
#include "vibe_testing/expect_error.hpp"
#include "vibe_vision/tag/tag_reader.hpp"

namespace vibe::vision::marker_sheet_test {
namespace {

constexpr double kRaster = 40e3;  // pixels per metre: 1016 dpi

VisionConfig twoInstruments() {
  VisionConfig config;
  InstrumentConfig helix, driver;
  helix.name = "helix";
  helix.marker = defaultSleeve();
  driver.name = "needle_driver";
  driver.marker = RingDesign{};
  config.instruments = {helix, driver};
  return config;
}

std::string fileName(const std::string& end) {
  return testing::TempDir() + "marker_sheet_" + std::to_string(getpid()) + end;
}

std::string contentOf(const std::string& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

std::string errorOf(const VisionConfig& config, const SheetOptions& options) {
  return vibe::errorOf([&] { MarkerSheet(config, options); });
}

/// Looks a page up in metres.
class Page {
 public:
  Page(const MarkerSheet& sheet, std::size_t index) : raster_(sheet.raster(index, kRaster)) {}

  /// 0 or 1; -1 if an edge is near
  int at(double x, double y) const {
    const int column = static_cast<int>(std::floor(x * kRaster)), row = static_cast<int>(std::floor(y * kRaster));
    const int middle = value(column, row);
    for (int dy = -1; dy <= 1; ++dy) {
      for (int dx = -1; dx <= 1; ++dx) {
        if (value(column + dx, row + dy) != middle) return -1;
      }
    }
    return middle > 127 ? 1 : 0;
  }

 private:
  SheetRaster raster_;

  int value(int x, int y) const {
    return raster_.value.at(static_cast<std::size_t>(y) * static_cast<std::size_t>(raster_.width) +
                            static_cast<std::size_t>(x));
  }
};

struct Agreement {
  int compared = 0, different = 0, black = 0;

  void add(int printed, double designed) {
    if (printed < 0) return;
    ++compared;
    if (printed != static_cast<int>(designed)) ++different;
    if (printed == 0) ++black;
  }
};

Agreement compareRing(const Page& page, const SheetItem& item, const RingDesign& ring) {
  Agreement agreement;
  for (double x = 2e-4; x < item.width - 2e-4; x += 7e-5) {
    for (double y = 2e-4; y < item.height - 2e-4; y += 7e-5) {
      agreement.add(page.at(item.x + x, item.y + y), reflectance(ring, x - item.width / 2, y - item.height / 2));
    }
  }
  return agreement;
}

Agreement compareSleeve(const Page& page, const SheetItem& item, const SleeveDesign& sleeve, double thickness) {
  Agreement agreement;
  const double turn = flatTurn(sleeve, thickness);
  for (double x = 2e-4; x < item.width - 2e-4; x += 7e-5) {
    for (double y = 2e-4; y < item.height - 2e-4; y += 7e-5) {
      const double phi = 2 * M_PI * (y / turn - 0.5);
      agreement.add(page.at(item.x + x, item.y + y), reflectance(sleeve, x - item.width / 2, phi));
    }
  }
  return agreement;
}

TEST(MarkerSheet, TheRasterOfEachMarkerIsItsDesign) {
  VisionConfig config = twoInstruments();
  SleeveDesign other = defaultSleeve();  // a left-handed stripe of another duty
  other.helix_pitch = -3.1e-3;
  other.helix_duty = 0.35;
  config.instruments.push_back(config.instruments[0]);
  config.instruments.back().name = "left";
  config.instruments.back().marker = other;
  const SheetOptions options;
  const MarkerSheet sheet(config, options);
  const Page page(sheet, 0);
  ASSERT_EQ(sheet.pages()[0].items.size(), 9U);
  for (const SheetItem& item : sheet.pages()[0].items) {
    SCOPED_TRACE(item.name);
    const auto* ring = std::get_if<RingDesign>(&item.marker);
    const Agreement agreement =
        ring != nullptr ? compareRing(page, item, *ring)
                        : compareSleeve(page, item, std::get<SleeveDesign>(item.marker), options.paper_thickness);
    EXPECT_GT(agreement.compared, 5000);
    EXPECT_GT(agreement.black, 500);
    EXPECT_EQ(agreement.different, 0);
  }
}

TEST(MarkerSheet, TagsAreThoseOfTheirLibraries) {
  VisionConfig config = twoInstruments();
  config.instruments[0].marker = TagDesign{TagFamily::AprilTag, 3, 8e-3};
  config.instruments[1].marker = TagDesign{TagFamily::Aruco, 9, 6e-3};
  const MarkerSheet sheet(config, {});
  const SheetRaster raster = sheet.raster(0, kRaster);
  for (const SheetItem& item : sheet.pages()[0].items) {
    const TagDesign tag = std::get<TagDesign>(item.marker);
    std::vector<std::uint8_t> piece;  // what a camera sees of a cut tag, at 0.1 mm/px
    const int size = static_cast<int>(item.width * 1e4);
    for (int y = 0; y < size; ++y)
      for (int x = 0; x < size; ++x)
        piece.push_back(raster.value[static_cast<std::size_t>((item.y * 1e4 + y + 0.5) * 4) *
                                         static_cast<std::size_t>(raster.width) +
                                     static_cast<std::size_t>((item.x * 1e4 + x + 0.5) * 4)]);
    const std::vector<TagCorners> found = TagReader(tag, 1e4).find({piece.data(), size, size, size});
    ASSERT_EQ(found.size(), 1U) << item.name;
    EXPECT_NEAR((found[0][0] - found[0][1]).norm(), tag.side * 1e4, 1) << item.name;
    const TagDesign other{tag.family, tag.id + 1, tag.side};
    EXPECT_TRUE(TagReader(other, 1e4).find({piece.data(), size, size, size}).empty());
  }
}

TEST(MarkerSheet, ControlAnotherDesignDoesNotMatchTheRaster) {
  const SheetOptions options;
  const MarkerSheet sheet(twoInstruments(), options);
  const Page page(sheet, 0);
  SleeveDesign mirrored = defaultSleeve(), larger = defaultSleeve();
  mirrored.helix_pitch = -mirrored.helix_pitch;
  larger.helix_pitch *= 1.1;
  const SheetItem& helix = sheet.pages()[0].items[0];
  EXPECT_GT(compareSleeve(page, helix, mirrored, options.paper_thickness).different, 500);
  EXPECT_GT(compareSleeve(page, helix, larger, options.paper_thickness).different, 10);
  EXPECT_GT(compareSleeve(page, helix, defaultSleeve(), 3e-4).different, 10);  // thicker paper, shorter turn
  EXPECT_GT(compareRing(page, sheet.pages()[0].items[3], RingDesign{4.1e-3, 2e-3, 7e-3}).different, 10);
}

TEST(MarkerSheet, PdfPagesHaveTheSizeOfThePaper) {
  for (const Paper paper : {Paper::A4, Paper::Letter}) {
    SheetOptions options;
    options.paper = paper;
    const std::string file = fileName(".pdf");
    MarkerSheet(twoInstruments(), options).writePdf(file);
    const std::string text = contentOf(file);
    const std::regex box(R"(/MediaBox \[ 0 0 ([0-9.]+) ([0-9.]+) \])");
    int pages = 0;
    for (std::sregex_iterator match(text.begin(), text.end(), box), end; match != end; ++match, ++pages) {
      EXPECT_NEAR(std::stod((*match)[1]), paper == Paper::A4 ? 595.2756 : 612, 1e-3);
      EXPECT_NEAR(std::stod((*match)[2]), paper == Paper::A4 ? 841.8898 : 792, 1e-3);
    }
    EXPECT_EQ(pages, 3);
    unlink(file.c_str());
  }
}

/// Smallest box around the points of a path of an SVG file.
struct Box {
  double left = 1e9, top = 1e9, right = -1e9, bottom = -1e9;

  explicit Box(const std::string& path) {
    const std::regex number(R"(-?[0-9.]+)");
    std::vector<double> values;
    for (std::sregex_iterator match(path.begin(), path.end(), number), end; match != end; ++match) {
      values.push_back(std::stod(match->str()));
    }
    for (std::size_t i = 0; i + 1 < values.size(); i += 2) {
      left = std::min(left, values[i]), right = std::max(right, values[i]);
      top = std::min(top, values[i + 1]), bottom = std::max(bottom, values[i + 1]);
    }
  }
};

/// Boxes of all filled paths, in the units of the file.
std::vector<Box> filledBoxes(const std::string& svg) {
  std::vector<Box> boxes;
  const std::regex path("<path style=\"[^\"]*fill:rgb\\(0%,0%,0%\\)[^\"]*\" d=\"([^\"]*)\"");
  for (std::sregex_iterator match(svg.begin(), svg.end(), path), end; match != end; ++match)
    boxes.emplace_back((*match)[1]);
  return boxes;
}

bool contains(const std::vector<Box>& boxes, double left, double top, double width, double height) {
  for (const Box& box : boxes) {
    if (std::abs(box.left - left) < 2e-3 && std::abs(box.top - top) < 2e-3 &&
        std::abs(box.right - left - width) < 2e-3 && std::abs(box.bottom - top - height) < 2e-3)
      return true;
  }
  return false;
}

TEST(MarkerSheet, SvgIsInMillimetresAndTheMarkersAreWhereThePagesSay) {
  const MarkerSheet sheet(twoInstruments(), {});
  const std::vector<std::string> files = sheet.writeSvg(fileName(".svg"));
  ASSERT_EQ(files.size(), 3U);
  const std::string text = contentOf(files[0]);
  EXPECT_NE(text.find("width=\"210mm\" height=\"297mm\" viewBox=\"0 0 210 297\""), std::string::npos);
  const std::vector<Box> boxes = filledBoxes(text);
  for (const SheetItem& item : sheet.pages()[0].items) {
    const double x = 1e3 * item.x, y = 1e3 * item.y;
    if (item.name == "needle_driver") {
      EXPECT_TRUE(contains(boxes, x + 1.5, y + 1.5, 4, 4)) << x << " " << y;
      EXPECT_FALSE(contains(boxes, x + 1.5, y + 1.5, 4.01, 4));
    } else {
      const auto& sleeve = std::get<SleeveDesign>(item.marker);
      for (const Bar& bar : sleeve.bars) {
        const double left = x + 1e3 * (bar.begin + sleeve.length / 2);
        EXPECT_TRUE(contains(boxes, left, y, 1e3 * (bar.end - bar.begin), 1e3 * item.height)) << left << " " << y;
      }
    }
  }
  for (const std::string& file : files) unlink(file.c_str());
}

TEST(MarkerSheet, ASleeveGoesOnceAroundTheMiddleOfThePaper) {
  SheetOptions options;
  options.paper_thickness = 2e-4;
  options.overlap = 3e-3;
  const MarkerSheet sheet(twoInstruments(), options);
  EXPECT_NEAR(sheet.pages()[0].items[0].height, M_PI * 2.8e-3 + 3e-3, 1e-12);
  EXPECT_NEAR(rodDiameter(defaultSleeve(), 2e-4), 2.6e-3, 1e-12);
}

TEST(MarkerSheet, BothRulersAreOneHundredMillimetresLong) {
  const Page page(MarkerSheet(twoInstruments(), {}), 0);
  // the end marks are as high as no other
  std::vector<double> marks;
  const double row = 0.297 - 0.015 - 0.003 - 0.0045;
  for (double x = 0; x < 0.16; x += 0.5 / kRaster)
    if (page.at(x, row) == 0 && (marks.empty() || x - marks.back() > 1e-3)) marks.push_back(x);
  ASSERT_EQ(marks.size(), 2U);
  EXPECT_NEAR(marks[1] - marks[0], 0.1, 5e-5);
  marks.clear();
  for (double y = 0.1; y < 0.29; y += 0.5 / kRaster)
    if (page.at(0.018 + 0.0045, y) == 0 && (marks.empty() || y - marks.back() > 1e-3)) marks.push_back(y);
  ASSERT_EQ(marks.size(), 2U);
  EXPECT_NEAR(marks[1] - marks[0], 0.1, 5e-5);
}

TEST(MarkerSheet, TheChessboardHasItsSquares) {
  SheetOptions options;
  options.board_spec = {7, 5, 8e-3};
  const MarkerSheet sheet(twoInstruments(), options);
  const SheetItem& board = sheet.pages()[1].items[0];
  EXPECT_NEAR(board.width, 64e-3, 1e-12);
  EXPECT_NEAR(board.height, 48e-3, 1e-12);
  const Page page(sheet, 1);
  for (int row = 0; row < 6; ++row) {
    for (int column = 0; column < 8; ++column) {
      const double x = board.x + (column + 0.5) * 8e-3, y = board.y + (row + 0.5) * 8e-3;
      EXPECT_EQ(page.at(x, y), (row + column) % 2);
      EXPECT_EQ(page.at(x - 3.9e-3, y - 3.9e-3), (row + column) % 2);
      EXPECT_EQ(page.at(x + 3.9e-3, y + 3.9e-3), (row + column) % 2);
    }
  }
}

TEST(MarkerSheet, NothingLiesOnAnythingElseAndAllIsOnThePaper) {
  for (const Paper paper : {Paper::A4, Paper::Letter}) {
    SheetOptions options;
    options.paper = paper;
    options.copies = 20;
    const MarkerSheet sheet(twoInstruments(), options);
    EXPECT_GT(sheet.pages().size(), 3U);
    for (const SheetPage& page : sheet.pages()) {
      for (std::size_t i = 0; i < page.items.size(); ++i) {
        const SheetItem& a = page.items[i];
        EXPECT_GT(a.x, 0.01);
        EXPECT_GT(a.y, 0.01);
        EXPECT_LT(a.x + a.width, sheet.width() - 0.01);
        EXPECT_LT(a.y + a.height, sheet.height() - 0.01);
        for (std::size_t j = 0; j < i; ++j) {
          const SheetItem& b = page.items[j];
          EXPECT_TRUE(a.x > b.x + b.width || b.x > a.x + a.width || a.y > b.y + b.height || b.y > a.y + a.height);
        }
      }
    }
  }
}

/// Share of a frame of 10 mm along the edges of a page that is printed on.
double printedInTheMargin(const MarkerSheet& sheet, std::size_t page) {
  constexpr double kCoarse = 4e3;  // pixels per metre
  const SheetRaster raster = sheet.raster(page, kCoarse);
  const int margin = static_cast<int>(10e-3 * kCoarse);
  int all = 0, dark = 0;
  for (int y = 0; y < raster.height; ++y)
    for (int x = 0; x < raster.width; ++x) {
      if (x >= margin && y >= margin && x < raster.width - margin && y < raster.height - margin) continue;
      ++all;
      if (raster.value[static_cast<std::size_t>(y * raster.width + x)] < 255) ++dark;
    }
  return static_cast<double>(dark) / all;
}

TEST(MarkerSheet, TheGuideFillsOnePage) {
  VisionConfig many = twoInstruments();
  while (many.instruments.size() < 8) {
    many.instruments.push_back(many.instruments[0]);
    many.instruments.back().name = "instrument_" + std::to_string(many.instruments.size());
  }
  SheetOptions options;
  options.markers = options.board = false;
  for (const Paper paper : {Paper::A4, Paper::Letter})
    for (const VisionConfig& config : {twoInstruments(), many}) {
      options.paper = paper;
      const MarkerSheet sheet(config, options);
      ASSERT_EQ(sheet.pages().size(), 1U);
      EXPECT_EQ(printedInTheMargin(sheet, 0), 0);
    }
  many.instruments[0].name = std::string(400, 'w');
  EXPECT_ERROR(MarkerSheet(many, options).raster(0, 1e3), "do not fit on one page");
}

/// What a terminal shows of a command in an empty folder.
std::string shown(const std::string& command) {
  FILE* pipe = ::popen(("cd /var/empty 2>/dev/null || cd /; " + command + " 2>&1").c_str(), "r");
  std::string text;
  for (int c = std::fgetc(pipe); c != EOF; c = std::fgetc(pipe)) text += static_cast<char>(c);
  ::pclose(pipe);
  return text;
}

TEST(MarkerSheet, TheCommandsOfTheGuideAreThoseOfThePrograms) {
  const std::string run = "rosrun vibe_vision ";
  SheetOptions options;
  options.config_file = "no_such_rig.yaml";
  int files = 0;
  for (const GuideStep& step : guideSteps(options, {"helix", "needle_driver"})) {
    ASSERT_EQ(step.command.rfind(run, 0), 0U);
    const std::string command = step.command.substr(run.size());
    if (command.rfind("vision_node", 0) == 0) continue;  // its parameters are checked with it
    const bool camera = command.rfind("vibe_camera_check", 0) == 0;
    const std::string answer = shown(VISION_PROGRAMS "/" + command + (camera ? " --duration 0.1 --wrong" : ""));
    EXPECT_EQ(answer.find("see --help") != std::string::npos, camera) << step.command << "\n" << answer;
    files += answer.find("no_such_rig") != std::string::npos ? 1 : 0;
  }
  EXPECT_EQ(files, 5);
}

TEST(MarkerSheet, WhatCannotBePrintedIsSaid) {
  VisionConfig config = twoInstruments();
  SheetOptions options;
  options.board_spec = {30, 20, 10e-3};
  EXPECT_NE(errorOf(config, options).find("does not fit on the paper; use smaller squares"), std::string::npos);
  options = {};
  options.paper_thickness = 8e-4;
  EXPECT_NE(errorOf(config, options).find("is too thick for the sleeve of 'helix'"), std::string::npos);
  options = {};
  config.instruments[1].marker = RingDesign{0.2, 0.1, 0.3};
  EXPECT_NE(errorOf(config, options).find("the marker of 'needle_driver' does not fit"), std::string::npos);
  EXPECT_THROW(MarkerSheet(twoInstruments(), {}).writePdf("/nowhere/sheet.pdf"), Error);
  EXPECT_THROW(MarkerSheet(twoInstruments(), {}).writeSvg("sheet.pdf"), Error);
}

}  // namespace
}  // namespace vibe::vision::marker_sheet_test
