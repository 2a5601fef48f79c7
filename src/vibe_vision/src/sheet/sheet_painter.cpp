#include <algorithm>
#include <cmath>

#include "calibrate/fitting.hpp"
#include "sheet/sheet_layout.hpp"
#include "vibe_core/program/error.hpp"
#include "vibe_vision/tag/tag_reader.hpp"

namespace vibe::vision {
namespace {

constexpr double kTextSize = 2.8e-3;
constexpr double kCutLine = 1e-4;
constexpr double kCutGrey = 0.6;
constexpr double kTolerance = 1e-6;  // of curves [m]

std::string inMillimetres(double length) {
  return withDecimals(1e3 * length, 2) + " mm";
}

class SheetPainter {
 public:
  SheetPainter(cairo_surface_t* surface, double units_per_metre, const SheetOptions& options)
      : context_(cairo_create(surface)), options_(options) {
    cairo_scale(context_, units_per_metre, units_per_metre);
    cairo_set_tolerance(context_, kTolerance * units_per_metre);
    cairo_select_font_face(context_, "sans-serif", CAIRO_FONT_SLANT_NORMAL, CAIRO_FONT_WEIGHT_NORMAL);
  }
  ~SheetPainter() { cairo_destroy(context_); }
  SheetPainter(const SheetPainter&) = delete;
  SheetPainter& operator=(const SheetPainter&) = delete;

  void paint(const SheetPage& page, std::size_t number, std::size_t count) {
    cairo_set_source_rgb(context_, 1, 1, 1);
    cairo_paint(context_);
    if (page.guided.empty()) {
      paintTitle(number, count);
      paintRulers();
      for (const SheetItem& item : page.items) paintItem(item);
    } else {
      paintGuide(context_, options_, page.guided);
    }
    cairo_show_page(context_);
    if (cairo_status(context_) != CAIRO_STATUS_SUCCESS) {
      throw Error(std::string("the marker sheet cannot be drawn: ") + cairo_status_to_string(cairo_status(context_)) +
                  "; report this as a defect");
    }
  }

 private:
  cairo_t* context_;
  const SheetOptions& options_;

  void paintTitle(std::size_t number, std::size_t count) {
    const double x = kPageMargin + kRulerBand, y = kPageMargin;
    text(x, y + 4e-3, 4e-3, "Markers, page " + std::to_string(number) + " of " + std::to_string(count));
    text(x, y + 9e-3, kTextSize, "Print at 100 %, without fitting to the page, on matt paper. Measure both rulers.");
  }

  void paintRulers() {
    const PaperExtent extent = extentOf(options_.paper);
    const double x = kPageMargin + kRulerBand, y = extent.height - kPageMargin;
    paintRuler(x, y - 3e-3, true);
    paintRuler(kPageMargin + 3e-3, y - kRulerBand - kRulerLength, false);
    text(x + kRulerLength + 4e-3, y - 3e-3, kTextSize, "Both rulers must measure 100.0 mm.");
  }

  void paintRuler(double x, double y, bool horizontal) {
    constexpr double kWidth = 2e-4;
    for (int mark = 0; mark <= 20; ++mark) {
      const double at = mark * kRulerLength / 20, tick = mark % 20 == 0 ? 5e-3 : (mark % 2 == 0 ? 3e-3 : 1.5e-3);
      if (horizontal) line(x + at, y, x + at, y - tick, kWidth, 0);
      if (!horizontal) line(x, y + at, x + tick, y + at, kWidth, 0);
    }
    if (horizontal) line(x, y, x + kRulerLength, y, kWidth, 0);
    if (!horizontal) line(x, y, x, y + kRulerLength, kWidth, 0);
  }

  void paintItem(const SheetItem& item) {
    if (item.name.empty()) {
      paintBoard(item);
    } else if (const auto* ring = std::get_if<RingDesign>(&item.marker)) {
      paintRing(item, *ring);
    } else if (const auto* tag = std::get_if<TagDesign>(&item.marker)) {
      paintTag(item, *tag);
    } else {
      paintSleeve(item, std::get<SleeveDesign>(item.marker));
    }
  }

  void label(const SheetItem& item, const std::string& what) {
    text(item.x, item.y - kGap - 3e-3, kTextSize, item.name);
    text(item.x, item.y - kGap + 0.5e-3, 0.8 * kTextSize, what);
  }

  void paintRing(const SheetItem& item, const RingDesign& ring) {
    const double x = item.x + item.width / 2, y = item.y + item.height / 2;
    label(item, "ring " + inMillimetres(ring.outer_diameter) + " / " + inMillimetres(ring.inner_diameter));
    paintCutLine(item);
    cairo_set_source_rgb(context_, 0, 0, 0);
    cairo_new_path(context_);
    cairo_arc(context_, x, y, ring.outer_diameter / 2, 0, 2 * M_PI);
    cairo_close_path(context_);
    cairo_new_sub_path(context_);
    cairo_arc_negative(context_, x, y, ring.inner_diameter / 2, 2 * M_PI, 0);
    cairo_close_path(context_);
    cairo_fill(context_);
  }

  void paintTag(const SheetItem& item, const TagDesign& tag) {
    label(item, std::string(tagFamilyName(tag.family)) + " " + std::to_string(tag.id) + ", " + inMillimetres(tag.side));
    paintCutLine(item);
    const int cells = tagCells(tag.family);
    const double cell = tag.side / cells;
    const std::vector<std::uint8_t> white = tagPicture(tag);
    cairo_set_source_rgb(context_, 0, 0, 0);
    cairo_new_path(context_);
    for (int row = 0; row < cells; ++row)
      for (int column = 0; column < cells; ++column)
        if (white[static_cast<std::size_t>(row * cells + column)] == 0)
          cairo_rectangle(context_, item.x + (column + 1) * cell, item.y + (row + 1) * cell, cell, cell);
    cairo_fill(context_);
  }

  void paintSleeve(const SheetItem& item, const SleeveDesign& sleeve) {
    const double turn = flatTurn(sleeve, options_.paper_thickness);
    paintSleeveHints(item, sleeve);
    paintCutLine(item);
    cairo_save(context_);
    cairo_translate(context_, item.x + item.width / 2, item.y + turn / 2);  // u = 0, phi = 0
    cairo_set_source_rgb(context_, 0, 0, 0);
    for (const Bar& bar : sleeve.bars) {
      cairo_rectangle(context_, bar.begin, -turn / 2, bar.end - bar.begin, item.height);
      cairo_fill(context_);
    }
    cairo_rectangle(context_, sleeve.helix_begin, -turn / 2, sleeve.helix_end - sleeve.helix_begin, item.height);
    cairo_clip(context_);
    paintStripe(sleeve, -0.5, -0.5 + item.height / turn);
    cairo_restore(context_);
  }

  /// @param from, to  in turns
  void paintStripe(const SleeveDesign& sleeve, double from, double to) {
    const double turn = flatTurn(sleeve, options_.paper_thickness);
    const double pitch = sleeve.helix_pitch, half = std::abs(pitch) * sleeve.helix_duty / 2;
    const double begin = sleeve.helix_begin / pitch, end = sleeve.helix_end / pitch;
    const int first = static_cast<int>(std::floor(std::min(begin, end) - to)) - 1;
    const int last = static_cast<int>(std::ceil(std::max(begin, end) - from)) + 1;
    for (int n = first; n <= last; ++n) {  // the centre line is u = pitch (turns + n)
      cairo_move_to(context_, pitch * (from + n) - half, from * turn);
      cairo_line_to(context_, pitch * (from + n) + half, from * turn);
      cairo_line_to(context_, pitch * (to + n) + half, to * turn);
      cairo_line_to(context_, pitch * (to + n) - half, to * turn);
      cairo_close_path(context_);
      cairo_fill(context_);
    }
  }

  void paintSleeveHints(const SheetItem& item, const SleeveDesign& sleeve) {
    const double turn = flatTurn(sleeve, options_.paper_thickness);
    label(item, "sleeve for a rod of " + inMillimetres(rodDiameter(sleeve, options_.paper_thickness)));
    text(item.x, item.y - kGap + 3.5e-3, 0.8 * kTextSize, "positive slide");
    arrow(item.x, item.y - 2.5e-3, item.x + item.width);
    const double right = item.x + item.width;
    for (const double at : {item.y + turn, item.y + turn / 2}) {
      line(item.x - 3e-3, at, item.x - 1e-3, at, kCutLine, 0);
      line(right + 1e-3, at, right + 3e-3, at, kCutLine, 0);
    }
    text(right + 4e-3, item.y + turn / 2 + 0.8e-3, 0.8 * kTextSize, "rotation 0");
    if (options_.overlap > 0)
      text(right + 4e-3, item.y + turn + options_.overlap / 2 + 1e-3, 0.8 * kTextSize, "glue under");
  }

  void paintBoard(const SheetItem& item) {
    const BoardSpec& board = options_.board_spec;
    text(item.x, item.y - board.square - 3e-3, kTextSize,
         "Chessboard, " + std::to_string(board.columns) + "x" + std::to_string(board.rows) +
             " inner corners, squares of " + inMillimetres(board.square) + ". Glue it on a flat plate.");
    cairo_set_source_rgb(context_, 0, 0, 0);
    for (int row = 0; row <= board.rows; ++row) {
      for (int column = row % 2; column <= board.columns; column += 2) {
        cairo_rectangle(context_, item.x + column * board.square, item.y + row * board.square, board.square,
                        board.square);
      }
    }
    cairo_fill(context_);
  }

  void paintCutLine(const SheetItem& item) {
    // the line is outside of what is cut out, so that none of it stays on the marker
    cairo_set_line_width(context_, kCutLine);
    cairo_set_source_rgb(context_, kCutGrey, kCutGrey, kCutGrey);
    cairo_rectangle(context_, item.x - kCutLine / 2, item.y - kCutLine / 2, item.width + kCutLine,
                    item.height + kCutLine);
    cairo_stroke(context_);
  }

  void line(double x0, double y0, double x1, double y1, double width, double grey) {
    cairo_set_line_width(context_, width);
    cairo_set_source_rgb(context_, grey, grey, grey);
    cairo_move_to(context_, x0, y0);
    cairo_line_to(context_, x1, y1);
    cairo_stroke(context_);
  }

  void arrow(double x0, double y0, double x1) {
    constexpr double kHead = 1.2e-3;
    line(x0, y0, x1 - kHead, y0, 2e-4, 0);
    cairo_move_to(context_, x1, y0);
    cairo_line_to(context_, x1 - 1.5 * kHead, y0 - kHead / 2);
    cairo_line_to(context_, x1 - 1.5 * kHead, y0 + kHead / 2);
    cairo_close_path(context_);
    cairo_fill(context_);
  }

  void text(double x, double y, double size, const std::string& words) {
    cairo_set_source_rgb(context_, 0, 0, 0);
    cairo_set_font_size(context_, size);
    cairo_move_to(context_, x, y);
    cairo_show_text(context_, words.c_str());
  }
};

}  // namespace

void paintPage(cairo_surface_t* surface, double units_per_metre, const SheetOptions& options, const SheetPage& page,
               std::size_t number, std::size_t count) {
  SheetPainter(surface, units_per_metre, options).paint(page, number, count);
}

}  // namespace vibe::vision
