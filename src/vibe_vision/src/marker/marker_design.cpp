#include "vibe_vision/marker/marker_design.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "vibe_core/program/error.hpp"

namespace vibe::vision {

double reflectance(const RingDesign& design, double x, double y) {
  const double diameter = 2 * std::hypot(x, y);
  return diameter < design.outer_diameter && diameter >= design.inner_diameter ? 0 : 1;
}

double reflectance(const SleeveDesign& design, double u, double phi) {
  for (const Bar& bar : design.bars)
    if (u >= bar.begin && u < bar.end) return 0;
  if (u < design.helix_begin || u >= design.helix_end) return 1;
  const double phase = u / design.helix_pitch - phi / (2 * M_PI) + design.helix_duty / 2;
  return phase - std::floor(phase) < design.helix_duty ? 0 : 1;
}

int tagCells(TagFamily family) {
  return family == TagFamily::AprilTag ? 8 : 6;
}
int tagCount(TagFamily family) {
  return family == TagFamily::AprilTag ? 587 : 50;
}
const char* tagFamilyName(TagFamily family) {
  return family == TagFamily::AprilTag ? "apriltag" : "aruco";
}
double tagMargin(const TagDesign& tag) {
  return tag.side / tagCells(tag.family);
}

/// Bars: of random layouts with at least ten edges, improved edge by edge, the one with the smallest side lobes of the
/// multiple correlation that the search uses, over motion blurs of 0 to 20 px, sizes of 0.75 to 1.1 and all rotations.
/// Stripe: one pitch long, so that every rotation shows as many edges. docs/vision.md, "Markers".
SleeveDesign defaultSleeve() {
  SleeveDesign design;
  design.diameter = 3e-3;
  design.length = 10e-3;
  design.bars = {{-4.05e-3, -3.75e-3}, {-3.35e-3, -2.75e-3}, {2.05e-3, 2.6e-3}, {3.05e-3, 3.45e-3}, {3.75e-3, 4.05e-3}};
  design.helix_begin = -2.2e-3;
  design.helix_end = 1.8e-3;
  design.helix_pitch = 4e-3;
  design.helix_duty = 0.5;
  return design;
}

namespace {

RingDesign widened(RingDesign ring, double ink) {
  const double most = (ring.outer_diameter - ring.inner_diameter) / 8;
  ink = std::clamp(ink, -most, std::min(most, ring.inner_diameter / 4));
  ring.outer_diameter += 2 * ink, ring.inner_diameter -= 2 * ink;
  return ring;
}

/// The edges of the stripe are not at right angles to the axis.
SleeveDesign widened(SleeveDesign sleeve, double ink) {
  double thinnest = sleeve.length, last = -sleeve.length;
  for (const Bar& bar : sleeve.bars) {
    thinnest = std::min({thinnest, bar.end - bar.begin, bar.begin - last});
    last = bar.end;
  }
  const double stretch = std::hypot(1, sleeve.helix_pitch / (M_PI * sleeve.diameter)) / std::abs(sleeve.helix_pitch);
  const double stripe = std::min(sleeve.helix_duty, 1 - sleeve.helix_duty) / stretch;
  ink = std::clamp(ink, -std::min(thinnest, stripe) / 4, std::min(thinnest, stripe) / 4);
  for (Bar& bar : sleeve.bars) bar.begin -= ink, bar.end += ink;
  sleeve.helix_begin -= ink, sleeve.helix_end += ink;
  sleeve.helix_duty += 2 * ink * stretch;
  return sleeve;
}

TagDesign widened(const TagDesign& tag, double) {
  return tag;
}

/// White that must be around a ring, and at both ends of a sleeve: as wide as the blur of a fast marker.
constexpr double kRingMargin = 0.15;    // of the outer diameter
constexpr double kSleeveMargin = 0.05;  // of the length

std::string millimetres(double length) {
  std::string text = std::to_string(length * 1e3);
  text.erase(text.find_last_not_of('0') + 1);
  if (text.back() == '.') text.pop_back();
  return text + " mm";
}

void require(bool good, const std::string& place, const std::string& sentence) {
  if (!good) throw Error(place + ": " + sentence);
}

void requireLength(double length, const std::string& place, const std::string& name) {
  require(std::isfinite(length) && length > 0 && length <= 0.1, place,
          name + " is " + millimetres(length) + "; it must be above 0 and at most 100 mm.");
}

void check(const RingDesign& ring, const std::string& place) {
  requireLength(ring.outer_diameter, place, "the ring's outer diameter");
  requireLength(ring.inner_diameter, place, "the ring's inner diameter");
  requireLength(ring.side, place, "the side of the ring's white square");
  require(ring.inner_diameter < ring.outer_diameter, place,
          "the ring's inner diameter is not below its outer diameter, " + millimetres(ring.outer_diameter) +
              "; nothing black would remain.");
  const double side = (1 + 2 * kRingMargin) * ring.outer_diameter;
  require(ring.side >= side, place,
          "the side of the ring's white square is " + millimetres(ring.side) + "; a ring of " +
              millimetres(ring.outer_diameter) + " needs at least " + millimetres(side) + ".");
}

void check(const TagDesign& tag, const std::string& place) {
  requireLength(tag.side, place, "the side of the tag");
  require(tag.id >= 0 && tag.id < tagCount(tag.family), place,
          "the number of the tag is " + std::to_string(tag.id) + "; " + tagFamilyName(tag.family) +
              " has tags from 0 to " + std::to_string(tagCount(tag.family) - 1) + ".");
}

void checkBars(const SleeveDesign& sleeve, const std::string& place) {
  require(sleeve.bars.size() >= 3, place,
          "the sleeve has " + std::to_string(sleeve.bars.size()) + " bars; its slide needs at least 3.");
  const double end = (0.5 - kSleeveMargin) * sleeve.length;
  double last = -end;
  for (std::size_t i = 0; i < sleeve.bars.size(); ++i) {
    const std::string name = "bar " + std::to_string(i + 1);
    const Bar& bar = sleeve.bars[i];
    require(std::isfinite(bar.begin) && std::isfinite(bar.end) && bar.begin < bar.end, place,
            name + " of the sleeve must begin before it ends; begin is " + millimetres(bar.begin) + ", end " +
                millimetres(bar.end) + ".");
    require(bar.begin >= last, place,
            i == 0 ? name + " of the sleeve begins at " + millimetres(bar.begin) + "; white is needed up to " +
                         millimetres(last) + "."
                   : name + " of the sleeve begins before the one before it ends; list them in ascending order.");
    last = bar.end;
  }
  require(
      last <= end, place,
      "the last bar of the sleeve ends at " + millimetres(last) + "; white is needed from " + millimetres(end) + ".");
}

void checkHelix(const SleeveDesign& sleeve, const std::string& place) {
  const double end = (0.5 - kSleeveMargin) * sleeve.length;
  require(std::isfinite(sleeve.helix_pitch) && std::abs(sleeve.helix_pitch) >= 0.2 * sleeve.diameter &&
              std::abs(sleeve.helix_pitch) <= 10 * sleeve.diameter,
          place,
          "the pitch of the sleeve's helix is " + millimetres(sleeve.helix_pitch) + "; its size must be from " +
              millimetres(0.2 * sleeve.diameter) + " to " + millimetres(10 * sleeve.diameter) + ".");
  require(sleeve.helix_duty >= 0.1 && sleeve.helix_duty <= 0.9, place,
          "the duty of the sleeve's helix is " + std::to_string(sleeve.helix_duty) + "; it must be from 0.1 to 0.9.");
  require(sleeve.helix_begin >= -end && sleeve.helix_end <= end && sleeve.helix_begin < sleeve.helix_end, place,
          "the sleeve's helix is from " + millimetres(sleeve.helix_begin) + " to " + millimetres(sleeve.helix_end) +
              "; it must lie between " + millimetres(-end) + " and " + millimetres(end) + ".");
  require(sleeve.helix_end - sleeve.helix_begin >= 0.5 * std::abs(sleeve.helix_pitch), place,
          "the sleeve's helix is shorter than half its pitch; some rotations would show no edge of it.");
  for (std::size_t i = 0; i < sleeve.bars.size(); ++i)
    require(sleeve.bars[i].end <= sleeve.helix_begin || sleeve.bars[i].begin >= sleeve.helix_end, place,
            "bar " + std::to_string(i + 1) + " of the sleeve lies in the helix; move one of them.");
}

/// Largest share of the edges that coincide, black on black and white on white, when the bars are shifted.
double selfSimilarity(const SleeveDesign& sleeve) {
  std::vector<std::pair<double, int>> edges;
  double thinnest = sleeve.length;
  for (const Bar& bar : sleeve.bars) {
    edges.insert(edges.end(), {{bar.begin, 1}, {bar.end, -1}});
    thinnest = std::min(thinnest, bar.end - bar.begin);
  }
  const double tolerance = 0.25 * thinnest;
  std::size_t most = 0;
  for (const auto& [from, sign] : edges)
    for (const auto& [to, other] : edges) {
      const double shift = to - from;
      if (sign != other || shift <= tolerance) continue;
      std::size_t same = 0;
      for (const auto& a : edges)
        for (const auto& b : edges)
          if (a.second == b.second && std::abs(b.first - a.first - shift) < tolerance) ++same;
      most = std::max(most, same);
    }
  return static_cast<double>(most) / static_cast<double>(edges.size());
}

void check(const SleeveDesign& sleeve, const std::string& place) {
  requireLength(sleeve.diameter, place, "the sleeve's diameter");
  requireLength(sleeve.length, place, "the sleeve's length");
  checkBars(sleeve, place);
  checkHelix(sleeve, place);
  require(selfSimilarity(sleeve) <= 0.5, place,
          "the sleeve's bars look the same after a shift; vary their widths and distances.");
}

}  // namespace

MarkerDesign printed(const MarkerDesign& design, double ink) {
  return std::visit([ink](const auto& marker) { return MarkerDesign(widened(marker, ink)); }, design);
}

void checkMarker(const MarkerDesign& design, const std::string& place) {
  std::visit([&](const auto& marker) { check(marker, place); }, design);
}

}  // namespace vibe::vision
