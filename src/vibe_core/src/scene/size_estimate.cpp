#include "scene/size_estimate.hpp"

#include <algorithm>
#include <cmath>

#include "arithmetic/elementary.hpp"
#include "geometry/regions.hpp"
#include "vibe_core/files/number_text.hpp"
#include "vibe_core/scene/unit.hpp"

namespace vibe {

namespace {

constexpr double kTypicalVolume = 0.7e-3;  // [m^3] Toro 2015: 0.71 +- 0.32 L
constexpr double kWallDensity = 1050;      // [kg/m^3]
constexpr double kAmbiguous = 0.5;         // mark where another unit is likely, too

/// Where stomachs are, and where nothing is like one any more.
struct Span {
  double none_below, from, to, none_above;
};

constexpr Span kVolumes{0.03e-3, 0.1e-3, 3e-3, 6e-3};  // [m^3]
constexpr Span kWalls{0.017, 0.05, 0.45, 1.35};        // [kg]
constexpr Span kLengths{0.06, 0.12, 0.5, 0.9};         // [m]

double markOf(double value, const Span& span) {
  const auto ramp = [](double x, double none, double all) {
    return std::clamp(math::log(x / none) / math::log(all / none), 0.0, 1.0);
  };
  if (!(value > span.none_below && value < span.none_above)) return 0;
  return std::min(ramp(value, span.none_below, span.from), ramp(value, span.none_above, span.to));
}

std::string quantity(double value, double factor, const char* unit) {
  const double number = value * factor;
  return formatted(number >= 100 && number < 1e6 ? "%.0f %s" : "%.2g %s", number, unit);
}

std::string volumeText(double volume) {
  return volume < 0.1e-3 ? quantity(volume, 1e6, "mL") : quantity(volume, 1e3, "L");
}

SizeEstimate judge(const LengthUnit& unit, double volume, double wall) {
  const double of_volume = markOf(volume, kVolumes), of_wall = markOf(wall, kWalls);
  SizeEstimate estimate{unit, std::min(of_volume, of_wall), ""};
  if (of_volume < kSureLandmarks || (of_volume <= of_wall && of_volume < 1)) {
    estimate.doubt = "it holds " + volumeText(volume) + ", and stomachs hold 0.1 to 3 L";
  } else if (of_wall < 1) {
    estimate.doubt =
        "its wall, as thick as in the scene, weighs " + quantity(wall, 1e3, "g") + ", and that of stomachs 50 to 450 g";
  }
  return estimate;
}

}  // namespace

const std::vector<LengthUnit>& lengthUnits() {
  static const std::vector<LengthUnit> units = [] {
    std::vector<LengthUnit> all;
    for (const auto& [name, metres] : knownLengths()) {
      const bool known =
          std::any_of(all.begin(), all.end(), [m = metres](const LengthUnit& u) { return u.metres == m; });
      if (!known) all.push_back({name, metres});
    }
    return all;
  }();
  return units;
}

SizeEstimate estimateUnit(const SurfaceMesh& surface, double thickness) {
  const double volume = enclosedVolume(surface), area = surfaceArea(surface);
  std::vector<SizeEstimate> guesses;
  for (const LengthUnit& unit : lengthUnits()) {
    const double square = unit.metres * unit.metres;
    guesses.push_back(judge(unit, volume * square * unit.metres, area * square * thickness * kWallDensity));
  }
  const auto distance = [&](const SizeEstimate& guess) {
    return std::abs(math::log(volume * guess.unit.metres * guess.unit.metres * guess.unit.metres / kTypicalVolume));
  };
  std::sort(guesses.begin(), guesses.end(), [&](const SizeEstimate& a, const SizeEstimate& b) {
    return a.confidence != b.confidence ? a.confidence > b.confidence : distance(a) < distance(b);
  });
  SizeEstimate best = guesses[0];
  if (const SizeEstimate& other = guesses[1]; other.confidence >= kSureLandmarks && best.confidence > kAmbiguous) {
    best.confidence = kAmbiguous;
    best.doubt = "it could be " + other.unit.name + " as well";
  }
  return best;
}

void addLengthMark(double length, SizeEstimate& estimate) {
  const double mark = markOf(length, kLengths);
  if (mark >= estimate.confidence) return;
  estimate.confidence = mark;
  estimate.doubt = "its axis is " + quantity(length, 1e3, "mm") + " long, and that of stomachs 120 to 500 mm";
}

}  // namespace vibe
