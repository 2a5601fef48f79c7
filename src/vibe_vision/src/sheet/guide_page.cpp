#include "sheet/guide_steps.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <sstream>

#include "calibrate/fitting.hpp"
#include "sheet/sheet_layout.hpp"
#include "vibe_core/program/error.hpp"

namespace vibe::vision {
namespace {

struct Colour {
  double red, green, blue;
};
constexpr Colour kInk = {0.13, 0.15, 0.18}, kAccent = {0.05, 0.35, 0.45}, kPale = {0.93, 0.95, 0.96},
                 kLight = {0.78, 0.84, 0.87}, kMetal = {0.70, 0.72, 0.75}, kGood = {0.10, 0.48, 0.24},
                 kBad = {0.70, 0.22, 0.14}, kWhite = {1, 1, 1};
constexpr double kMargin = 14e-3;                                // of the page, everything here in metres
constexpr double kBody = 2.75e-3, kCode = 2.35e-3, kLead = 1.4;  // sizes of text; distance of lines, in sizes
constexpr double kPanelHeight = 48e-3, kPanelGap = 5e-3;         // of the three pictures
constexpr double kBadge = 2.9e-3, kIndent = 9e-3;                // radius of a number; text beside it
constexpr double kLeastRoom = 1.2e-3, kMostRoom = 6e-3;          // after a step
constexpr double kMark = 4.2e-3;                                 // room of a tick or a cross

/// What has no room in a step.
const char* const kFurther =
    "No gauge blocks: step 5 with --images 'motion/*.png' instead of --stops takes a free motion; the scale is then as "
    "good as the print. Another camera, PTP, network, every number and its meaning: docs/vision.md.";

enum class Face { Plain, Bold, Code };

/// Draws the page from the top down.
class GuidePainter {
 public:
  /// @param room  after a step; 0: to be found out
  GuidePainter(cairo_t* context, const PaperExtent& paper, double room)
      : context_(context), room_(room), left_(kMargin), right_(paper.width - kMargin), bottom_(paper.height - kMargin) {
    cairo_font_options_t* options = cairo_font_options_create();
    cairo_font_options_set_hint_metrics(options, CAIRO_HINT_METRICS_OFF);  // as wide on a screen as on paper
    cairo_set_font_options(context_, options);
    cairo_font_options_destroy(options);
  }

  /// @return the room that there is after each step; 0 if it was known already
  double paint(const SheetOptions& options, const std::vector<std::string>& instruments) {
    head(listOf(instruments));
    pictures();
    const std::vector<GuideStep> steps = guideSteps(options, instruments);
    for (std::size_t i = 0; i < steps.size(); ++i) step(i + 1, steps[i]);
    style(kAccent, Face::Plain, 0.92 * kBody);
    y_ = flow(left_, y_ + 2e-3, right_ - left_, 0.92 * kBody, kFurther).y;
    if (room_ > 0) return 0;
    const double room = (bottom_ - y_) / static_cast<double>(steps.size());
    if (room < kLeastRoom)
      throw Error("the instructions for '" + options.config_file +
                  "' do not fit on one page; give the instruments shorter names, or leave the page out");
    return std::min(room, kMostRoom);
  }

 private:
  cairo_t* context_;
  double room_, left_, right_, bottom_, y_ = kMargin;

  void colour(const Colour& c) { cairo_set_source_rgb(context_, c.red, c.green, c.blue); }
  /// Of the words that follow.
  void style(const Colour& c, Face which, double size) {
    colour(c);
    cairo_select_font_face(context_, which == Face::Code ? "monospace" : "sans-serif", CAIRO_FONT_SLANT_NORMAL,
                           which == Face::Bold ? CAIRO_FONT_WEIGHT_BOLD : CAIRO_FONT_WEIGHT_NORMAL);
    cairo_set_font_size(context_, size);
  }
  double widthOf(const std::string& words) {
    cairo_text_extents_t extents;
    cairo_text_extents(context_, words.c_str(), &extents);
    return extents.x_advance;
  }
  void at(double x, double y, const std::string& words) {
    cairo_move_to(context_, x, y);
    cairo_show_text(context_, words.c_str());
  }
  void centred(double x, double y, const std::string& words) { at(x - widthOf(words) / 2, y, words); }

  /// Pieces of a text that stay together: words, or an option with what follows it.
  static std::vector<std::string> piecesOf(const std::string& words, const std::string& before) {
    std::vector<std::string> pieces;
    std::istringstream stream(words);
    std::string word;
    while (stream >> word) {
      if (pieces.empty() || word.rfind(before, 0) == 0)
        pieces.push_back(word);
      else
        pieces.back() += " " + word;
    }
    return pieces;
  }

  /// Words in lines from a first baseline; they begin `begin` behind x. `mark` ends each line but the last, and lines
  /// end before what begins with `before` only. @return the last baseline, and where it ends
  struct End {
    double x, y;
  };
  End flow(double x, double y, double width, double size, const std::string& words, double begin = 0,
           const std::string& mark = "", const std::string& before = "") {
    std::string line;
    double start = begin;
    for (const std::string& piece : piecesOf(words, before)) {
      const std::string longer = line.empty() ? piece : line + " " + piece;
      if (start + widthOf(longer + mark) > width && !line.empty()) {
        at(x + start, y, line + mark);
        y += kLead * size, start = 0, line = piece;
      } else {
        line = longer;
      }
    }
    at(x + start, y, line);
    return {x + start + widthOf(line), y};
  }

  void head(const std::string& instruments) {
    style(kAccent, Face::Bold, 5.6e-3);
    at(left_, y_ + 5e-3, "Calibrate the camera");
    style(kInk, Face::Plain, kBody);
    const std::string words =
        "From the print to tracked instruments (" + instruments +
        "). Keep the order, and go on when the answer is the one with the tick. In each terminal first: source "
        "devel/setup.bash";
    y_ = flow(left_, y_ + 11e-3, right_ - left_, kBody, words).y + 3.5e-3;
  }

  void pictures() {
    const double width = (right_ - left_ - 2 * kPanelGap) / 3;
    const std::array<const char*, 3> names = {"the rig", "steps 3 and 4: chessboard", "step 5: known slides"};
    for (int i = 0; i < 3; ++i) {
      const double x = left_ + i * (width + kPanelGap);
      roundedBox(x, y_, width, kPanelHeight, 2e-3, kPale);
      style(kAccent, Face::Bold, 0.9 * kBody);
      at(x + 2.5e-3, y_ + 4.5e-3, names[static_cast<std::size_t>(i)]);
      cairo_save(context_);
      cairo_translate(context_, x + width / 2, y_ + 26e-3);
      if (i == 0) rig();
      if (i == 1) boards();
      if (i == 2) slides();
      cairo_restore(context_);
    }
    y_ += kPanelHeight + 6e-3;
  }

  void roundedBox(double x, double y, double width, double height, double radius, const Colour& fill) {
    colour(fill);
    cairo_new_sub_path(context_);
    cairo_arc(context_, x + width - radius, y + radius, radius, -M_PI / 2, 0);
    cairo_arc(context_, x + width - radius, y + height - radius, radius, 0, M_PI / 2);
    cairo_arc(context_, x + radius, y + height - radius, radius, M_PI / 2, M_PI);
    cairo_arc(context_, x + radius, y + radius, radius, M_PI, 1.5 * M_PI);
    cairo_close_path(context_);
    cairo_fill(context_);
  }
  void box(double x, double y, double width, double height, const Colour& fill) {
    colour(fill);
    cairo_new_path(context_);
    cairo_rectangle(context_, x, y, width, height);
    cairo_fill(context_);
  }
  struct Point {
    double x, y;
  };
  void polygon(const std::vector<Point>& corners) {
    cairo_new_path(context_);
    for (const Point& corner : corners) cairo_line_to(context_, corner.x, corner.y);
    cairo_close_path(context_);
    cairo_fill(context_);
  }
  void stroke(double x0, double y0, double x1, double y1, double width, const Colour& c) {
    colour(c);
    cairo_set_line_width(context_, width);
    cairo_move_to(context_, x0, y0);
    cairo_line_to(context_, x1, y1);
    cairo_stroke(context_);
  }
  void arrow(double x0, double y0, double x1, double y1) {
    stroke(x0, y0, x1, y1, 3e-4, kAccent);
    const double angle = std::atan2(y1 - y0, x1 - x0);
    std::vector<Point> head{{x1 + 6e-4 * std::cos(angle), y1 + 6e-4 * std::sin(angle)}};
    for (const double side : {-1.0, 1.0})
      head.push_back({x1 - 1.4e-3 * std::cos(angle + 0.45 * side), y1 - 1.4e-3 * std::sin(angle + 0.45 * side)});
    polygon(head);
  }
  void label(double x, double y, const std::string& words) {
    style(kInk, Face::Plain, 2.2e-3);
    centred(x, y, words);
  }

  /// A rod along x with a sleeve around it, not to scale.
  void rod(double x, double y, double length, double sleeve_x) {
    box(x, y - 1.1e-3, length, 2.2e-3, kMetal);
    const SleeveDesign design = defaultSleeve();
    constexpr double kEnlarged = 1.35;
    cairo_save(context_);
    cairo_translate(context_, sleeve_x, y);
    cairo_scale(context_, kEnlarged, kEnlarged);
    const double half = design.length / 2, radius = design.diameter / 2;
    box(-half, -radius, design.length, design.diameter, kWhite);
    for (const Bar& bar : design.bars) box(bar.begin, -radius, bar.end - bar.begin, design.diameter, kInk);
    cairo_rectangle(context_, design.helix_begin, -radius, design.helix_end - design.helix_begin, design.diameter);
    cairo_clip(context_);
    for (int n = -1; n <= 1; ++n) stripe(design, n * design.helix_pitch);
    cairo_restore(context_);
  }
  /// What a camera sees of one turn of the stripe: half a turn, phi from -90 to 90 degrees.
  void stripe(const SleeveDesign& design, double u) {
    const double half = design.helix_pitch * design.helix_duty / 2, radius = design.diameter / 2;
    constexpr int kPieces = 16;
    std::vector<Point> outline;
    for (int i = 0; i <= 2 * kPieces + 1; ++i) {
      const bool back = i > kPieces;
      const double phi = M_PI * ((back ? 2 * kPieces + 1 - i : i) / static_cast<double>(kPieces) - 0.5);
      outline.push_back({u + design.helix_pitch * phi / (2 * M_PI) + (back ? half : -half), radius * std::sin(phi)});
    }
    polygon(outline);
  }
  void ring(double x, double y, double radius) {
    box(x - 1.75 * radius, y - 1.75 * radius, 3.5 * radius, 3.5 * radius, kWhite);
    colour(kInk);
    cairo_set_line_width(context_, radius / 2);
    cairo_new_path(context_);
    cairo_arc(context_, x, y, 0.75 * radius, 0, 2 * M_PI);
    cairo_stroke(context_);
  }

  void rig() {
    colour(kLight);
    polygon({{-1e-3, -8e-3}, {1e-3, -8e-3}, {23e-3, 17e-3}, {-23e-3, 17e-3}});
    box(-5e-3, -18e-3, 10e-3, 6.5e-3, kInk);                                                           // camera
    box(-3e-3, -11.5e-3, 6e-3, 3.5e-3, kMetal);                                                        // lens
    for (const double side : {-1.0, 1.0}) box(side * 6e-3 - 1.6e-3, -10e-3, 3.2e-3, 1.6e-3, kAccent);  // ring light
    style(kInk, Face::Plain, 2.2e-3);
    at(6.2e-3, -14.2e-3, "sharp and fixed");
    at(9e-3, -8.4e-3, "ring light");
    rod(-21e-3, 4e-3, 42e-3, -5e-3);
    arrow(5e-3, -0.2e-3, 14e-3, -0.2e-3);
    box(-21e-3, 11.4e-3, 42e-3, 1.6e-3, kMetal);
    ring(6e-3, 12.2e-3, 2e-3);
    arrow(11.5e-3, 9.5e-3, 17e-3, 9.5e-3);
    label(0, 19.8e-3, "looks across the axes, 0.1 mm per pixel");
  }

  /// A board of squares whose corners are given, upper left first, clockwise.
  void board(const std::array<Point, 4>& corner) {
    constexpr int kColumns = 6, kRows = 4;
    const auto inside = [&](double u, double v) {
      const auto mixed = [&](double Point::*c) {
        return (1 - v) * ((1 - u) * corner[0].*c + u * corner[1].*c) + v * ((1 - u) * corner[3].*c + u * corner[2].*c);
      };
      return Point{mixed(&Point::x), mixed(&Point::y)};
    };
    for (int row = 0; row < kRows; ++row)
      for (int column = 0; column < kColumns; ++column) {
        colour((row + column) % 2 == 0 ? kInk : kWhite);
        std::vector<Point> square;
        for (const auto& [u, v] : {Point{0, 0}, Point{1, 0}, Point{1, 1}, Point{0, 1}})
          square.push_back(inside((column + u) / kColumns, (row + v) / kRows));
        polygon(square);
      }
  }
  void boards() {
    box(-27e-3, -17e-3, 54e-3, 34e-3, kWhite);
    const auto tilted = [this](double x, double y, double left, double right, double top, double low) {
      constexpr double kWide = 6e-3, kHigh = 4e-3;  // halves; the sides are shorter by these factors
      board({{{x - kWide * top, y - kHigh * left},
              {x + kWide * top, y - kHigh * right},
              {x + kWide * low, y + kHigh * right},
              {x - kWide * low, y + kHigh * left}}});
    };
    const double x = 17.5e-3, y = 10.4e-3, below = 6.2e-3;
    tilted(-x, -y, 0.66, 1.1, 0.85, 0.85);
    label(-x, -y + below, "left side away");
    tilted(x, -y, 1.1, 0.66, 0.85, 0.85);
    label(x, -y + below, "right side away");
    tilted(0, 0, 1, 1, 1, 1);
    tilted(-x, y - 2e-3, 0.85, 0.85, 0.66, 1.1);
    label(-x, y - 2e-3 + below, "upper side away");
    tilted(x, y - 2e-3, 0.85, 0.85, 1.1, 0.66);
    label(x, y - 2e-3 + below, "lower side away");
    label(0, 19.8e-3, "whole board in view, all over the image");
  }

  void slides() {
    box(-25e-3, -10.5e-3, 4e-3, 12e-3, kAccent);  // a stop that stays
    box(-21e-3, -8.8e-3, 11e-3, 7e-3, kLight);    // gauge block
    label(-15.5e-3, -4.6e-3, "10 mm");
    rod(-10e-3, -5.3e-3, 35e-3, 7e-3);
    arrow(2e-3, -11e-3, 14e-3, -11e-3);
    label(8e-3, -12.2e-3, "positive slide");
    label(-13e-3, 4.2e-3, "stop");
    stroke(-15.5e-3, 3.4e-3, -20.4e-3, 1.2e-3, 1.5e-4, kInk);
    label(3e-3, 4.2e-3, "gauge block");
    stroke(-4.4e-3, 3.4e-3, -11.5e-3, -1.4e-3, 1.5e-4, kInk);
    roundedBox(-25e-3, 6.5e-3, 50e-3, 13e-3, 1e-3, kWhite);
    style(kInk, Face::Code, kCode);
    const std::array<const char*, 3> lines = {"image,slide", "stop_00.png,0 mm", "stop_10.png,10 mm"};
    for (std::size_t i = 0; i < lines.size(); ++i) at(-23e-3, (10.3 + 3.6 * static_cast<double>(i)) * 1e-3, lines[i]);
    style(kInk, Face::Plain, 2.2e-3);
    at(11e-3, 10.3e-3, "stops.csv");
  }

  void step(std::size_t number, const GuideStep& s) {
    const double x = left_ + kIndent, width = right_ - x;
    colour(kAccent);
    cairo_new_path(context_);
    cairo_arc(context_, left_ + kBadge, y_ + kBadge, kBadge, 0, 2 * M_PI);
    cairo_fill(context_);
    style(kWhite, Face::Bold, 1.15 * kBody);
    centred(left_ + kBadge, y_ + kBadge + 1.15e-3, std::to_string(number));
    style(kInk, Face::Bold, kBody);
    const double baseline = y_ + kBody + 0.6e-3;
    at(x, baseline, s.title);
    const double begin = widthOf(s.title + " ");
    style(kInk, Face::Plain, kBody);
    y_ = flow(x, baseline, width, kBody, s.what, begin).y + 2e-3;
    code(x, width, s.command);
    const double half = 0.38 * width, gap = 3e-3;
    const double end = answer(x, half, s.right, true);
    y_ = std::max(end, answer(x + half + gap, width - half - gap, s.wrong, false)) + room_;
  }

  /// A grey box with a command.
  void code(double x, double width, const std::string& command) {
    constexpr double kPad = 1.3e-3;
    cairo_push_group(context_);  // how many lines there are decides on the box
    style(kInk, Face::Code, kCode);
    const double first = y_ + kPad + 0.8 * kCode;
    const double last = flow(x + kPad, first, width - 2 * kPad, kCode, command, 0, " \\", "--").y;
    cairo_pattern_t* words = cairo_pop_group(context_);
    roundedBox(x, y_, width, last - y_ + 0.4 * kCode + kPad, 1e-3, kPale);
    cairo_set_source(context_, words);
    cairo_paint(context_);
    cairo_pattern_destroy(words);
    y_ = last + 0.4 * kCode + kPad + 1.2e-3;
  }

  /// What the command says if all is well, or what to do. @return where the words end
  double answer(double x, double width, const std::string& words, bool good) {
    const double size = 0.92 * kBody, baseline = y_ + size;
    colour(good ? kGood : kBad);
    cairo_set_line_width(context_, 5e-4);
    cairo_set_line_cap(context_, CAIRO_LINE_CAP_ROUND);
    if (good) {
      cairo_move_to(context_, x + 0.6e-3, baseline - 0.9e-3);
      cairo_line_to(context_, x + 1.3e-3, baseline - 0.2e-3);
      cairo_line_to(context_, x + 2.7e-3, baseline - 2e-3);
    } else {
      cairo_move_to(context_, x + 0.8e-3, baseline - 1.9e-3);
      cairo_line_to(context_, x + 2.5e-3, baseline - 0.2e-3);
      cairo_move_to(context_, x + 2.5e-3, baseline - 1.9e-3);
      cairo_line_to(context_, x + 0.8e-3, baseline - 0.2e-3);
    }
    cairo_stroke(context_);
    cairo_set_line_cap(context_, CAIRO_LINE_CAP_BUTT);
    style(kInk, Face::Plain, size);
    return flow(x + kMark, baseline, width - kMark, size, words).y + 0.3 * size;
  }
};

}  // namespace

void paintGuide(cairo_t* context, const SheetOptions& options, const std::vector<std::string>& instruments) {
  const PaperExtent paper = extentOf(options.paper);
  cairo_push_group(context);
  const double room = GuidePainter(context, paper, 0).paint(options, instruments);
  cairo_pattern_destroy(cairo_pop_group(context));
  GuidePainter(context, paper, room).paint(options, instruments);
}

}  // namespace vibe::vision
