#include "sheet/sheet_layout.hpp"

#include <algorithm>

#include "vibe_core/program/error.hpp"
#include "vibe_core/scene/yaml_source.hpp"

namespace vibe::vision {
namespace {

/// The part of a page that markers may use.
struct Area {
  double left, top, right, bottom;
};

Area areaOf(Paper paper) {
  const PaperExtent extent = extentOf(paper);
  return {kPageMargin + kRulerBand, kPageMargin + kTitleHeight, extent.width - kPageMargin,
          extent.height - kPageMargin - kRulerBand};
}

SheetItem itemOf(const InstrumentConfig& instrument, const SheetOptions& options) {
  SheetItem item;
  item.name = instrument.name;
  item.marker = instrument.marker;
  if (const auto* ring = std::get_if<RingDesign>(&instrument.marker)) {
    item.width = item.height = ring->side;
    return item;
  }
  if (const auto* tag = std::get_if<TagDesign>(&instrument.marker)) {
    item.width = item.height = tag->side + 2 * tagMargin(*tag);
    return item;
  }
  const auto& sleeve = std::get<SleeveDesign>(instrument.marker);
  if (options.paper_thickness >= 0.2 * sleeve.diameter) {
    throw Error("the paper of " + showQuantity(options.paper_thickness, "m") + " is too thick for the sleeve of '" +
                instrument.name + "' with a diameter of " + showQuantity(sleeve.diameter, "m") +
                "; use thinner paper, or give its thickness in metres");
  }
  item.width = sleeve.length;
  item.height = flatTurn(sleeve, options.paper_thickness) + options.overlap;
  return item;
}

/// Fills pages row by row.
class Flow {
 public:
  explicit Flow(Paper paper) : area_(areaOf(paper)) { newPage(); }

  void place(SheetItem item) {
    const double width = std::max(item.width + 2 * kGap, 50e-3);  // room for the label
    const double height = item.height + 2 * kGap + kLabelHeight;
    if (width > area_.right - area_.left || height > area_.bottom - area_.top) {
      throw Error("the marker of '" + item.name + "' does not fit on the paper; make it smaller");
    }
    if (x_ + width > area_.right) newRow();
    if (y_ + height > area_.bottom) newPage();
    item.x = x_ + kGap;
    item.y = y_ + kLabelHeight + kGap;
    pages_.back().items.push_back(item);
    x_ += width;
    row_ = std::max(row_, height);
  }
  void newRow() {
    x_ = area_.left;
    y_ += row_;
    row_ = 0;
  }

  std::vector<SheetPage> take() { return std::move(pages_); }

 private:
  void newPage() {
    pages_.emplace_back();
    x_ = area_.left;
    y_ = area_.top;
    row_ = 0;
  }

  Area area_;
  std::vector<SheetPage> pages_;
  double x_ = 0, y_ = 0, row_ = 0;
};

SheetPage boardPage(const SheetOptions& options) {
  const Area area = areaOf(options.paper);
  const BoardSpec& board = options.board_spec;
  SheetItem item;
  item.width = (board.columns + 1) * board.square;
  item.height = (board.rows + 1) * board.square;
  const double room_x = area.right - area.left - 2 * board.square;  // a square of white all around
  const double room_y = area.bottom - area.top - 2 * board.square - kLabelHeight;
  if (item.width > room_x || item.height > room_y) {
    throw Error("a chessboard of " + std::to_string(board.columns) + " x " + std::to_string(board.rows) +
                " corners with squares of " + showQuantity(board.square, "m") +
                " does not fit on the paper; use smaller squares or fewer of them");
  }
  item.x = area.left + board.square + (room_x - item.width) / 2;
  item.y = area.top + board.square + kLabelHeight;
  return {{item}, {}};
}

SheetPage guidePage(const VisionConfig& config) {
  SheetPage page;
  for (const InstrumentConfig& instrument : config.instruments) page.guided.push_back(instrument.name);
  return page;
}

void check(const SheetOptions& options) {
  const auto inside = [](double value, double low, double high) { return value >= low && value <= high; };
  if (!inside(options.paper_thickness, 0, 1e-3)) {
    throw Error("a paper thickness of " + showQuantity(options.paper_thickness, "m") +
                " is not possible; give 0 to 1 mm");
  }
  if (!inside(options.overlap, 0, 0.02)) {
    throw Error("an overlap of " + showQuantity(options.overlap, "m") + " is not possible; give 0 to 20 mm");
  }
  if (options.copies < 1 || options.copies > 50) throw Error("give 1 to 50 copies of each marker");
  const BoardSpec& board = options.board_spec;
  if (board.columns < 3 || board.rows < 3 || board.columns > 100 || board.rows > 100) {
    throw Error("a chessboard needs 3 to 100 inner corners per side; give for example 9x6");
  }
  if (!inside(board.square, 5e-4, 0.1)) {
    throw Error("chessboard squares of " + showQuantity(board.square, "m") + " are not possible; give 0.5 to 100 mm");
  }
}

}  // namespace

PaperExtent extentOf(Paper paper) {
  return paper == Paper::A4 ? PaperExtent{0.210, 0.297} : PaperExtent{8.5 * 25.4e-3, 11 * 25.4e-3};
}

std::vector<SheetPage> layOut(const VisionConfig& config, const SheetOptions& options) {
  check(options);
  std::vector<SheetPage> pages;
  if (options.markers) {
    Flow flow(options.paper);
    for (const InstrumentConfig& instrument : config.instruments) {
      for (int copy = 0; copy < options.copies; ++copy) flow.place(itemOf(instrument, options));
      flow.newRow();
    }
    pages = flow.take();
  }
  if (options.board) pages.push_back(boardPage(options));
  if (options.guide && !config.instruments.empty()) pages.push_back(guidePage(config));
  if (pages.empty()) throw Error("a sheet without markers, chessboard and guide is empty; leave one of them in");
  return pages;
}

}  // namespace vibe::vision
