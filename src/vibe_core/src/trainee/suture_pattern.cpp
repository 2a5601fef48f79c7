#include "vibe_core/trainee/suture_pattern.hpp"

#include <cmath>
#include <string>

#include "arithmetic/elementary.hpp"
#include "vibe_core/program/error.hpp"
#include "vibe_core/suture/technique_patterns.hpp"

namespace vibe {

namespace {

using Flat = std::vector<Eigen::Vector2d>;

// Corners in a square of side one around the origin: x distal, y to the front.
Flat cornersOf(Technique technique) {
  const double h = 0.5;
  switch (technique) {
    case Technique::U:  // the legs run around the organ, distal leg first
      return {{h, h}, {h, -h}, {-h, -h}, {-h, h}};
    case Technique::Z:
      return {{h, h}, {h, -h}, {-h, h}, {-h, -h}};
    case Technique::Triangular:
      return {{h, h}, {h, -h}, {-h, 0}, {h, h}};
    case Technique::Square:
      return {{h, h}, {h, -h}, {-h, -h}, {-h, h}, {h, h}};
    default:
      return {{h, 0}, {-h, 0}};
  }
}

Flat arc(int bites) {
  Flat places;
  for (int k = 0; k < bites; ++k) {
    const double angle = -M_PI * 2 / 3 + M_PI * 4 / 3 * k / (bites - 1);  // 240 degrees, open to the proximal side
    places.emplace_back(0.5 * math::cos(angle), -0.5 * math::sin(angle));
  }
  return places;
}

// How many of `vectors` each side gets: at least one, the others where the steps are longest.
std::vector<int> share(const Flat& corners, int vectors) {
  const std::size_t sides = corners.size() - 1;
  std::vector<int> shared(sides, 1);
  for (int k = static_cast<int>(sides); k < vectors; ++k) {
    const auto step = [&](std::size_t s) { return (corners[s + 1] - corners[s]).norm() / shared[s]; };
    std::size_t longest = 0;
    for (std::size_t s = 1; s < sides; ++s)
      if (step(s) > step(longest) + 1e-9) longest = s;
    ++shared[longest];
  }
  return shared;
}

}  // namespace

std::vector<Eigen::Vector2d> suturePattern(Technique technique, int bites, double length, double width) {
  if (technique == Technique::Other || bites < fewestBites(technique) || bites > kTechniqueMaxBites)
    throw Error("A pattern '" + std::string(toString(technique)) + "' of " + std::to_string(bites) +
                " bites does not exist; use u, z, triangular, square, running or c with 4 (square: 5) to 16 bites.");
  const Eigen::Array2d size(length, width);
  Flat places;
  if (technique == Technique::C) {
    places = arc(bites);
    for (Eigen::Vector2d& place : places) place.array() *= size;
    return places;
  }
  Flat corners = cornersOf(technique);
  for (Eigen::Vector2d& corner : corners) corner.array() *= size;
  const std::vector<int> shared = share(corners, bites - 1);
  places.push_back(corners.front());
  for (std::size_t s = 0; s < shared.size(); ++s)
    for (int k = 1; k <= shared[s]; ++k)
      places.push_back(corners[s] + static_cast<double>(k) / shared[s] * (corners[s + 1] - corners[s]));
  return places;
}

}  // namespace vibe
