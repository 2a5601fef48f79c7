#include "suture/set_layout.hpp"

#include <algorithm>
#include <cmath>

#include "vibe_core/common/error.hpp"

namespace vibe::benchmarks {
namespace {

constexpr double kArc = 110 * 3.14159265358979323846 / 180;  // half of the sweep of a C [rad]

std::vector<Eigen::Vector2d> throughCorners(const std::vector<Eigen::Vector2d>& corners, int vectors_per_leg) {
  std::vector<Eigen::Vector2d> bites{corners.front()};
  for (std::size_t leg = 1; leg < corners.size(); ++leg)
    for (int k = 1; k <= vectors_per_leg; ++k)
      bites.push_back(corners[leg - 1] + (corners[leg] - corners[leg - 1]) * k / vectors_per_leg);
  return bites;
}

/// Has the same width and length as the other patterns.
std::vector<Eigen::Vector2d> arc(int bites) {
  std::vector<Eigen::Vector2d> points;
  const double lowest = std::cos(kArc);
  for (int k = 0; k < bites; ++k) {
    const double angle = kArc * (2.0 * k / (bites - 1) - 1);
    points.emplace_back(2 * (std::cos(angle) - lowest) / (1 - lowest) - 1, 0.5 + 0.5 * std::sin(angle));
  }
  double min = points.front().y(), max = min;
  for (const auto& p : points) min = std::min(min, p.y()), max = std::max(max, p.y());
  for (auto& p : points) p.y() = (p.y() - min) / (max - min);
  return points;
}

}  // namespace

std::vector<Eigen::Vector2d> patternBites(const std::string& pattern, int bites) {
  if (bites < 4 || bites % 3 != 1)
    throw Error("A pattern of " + std::to_string(bites) +
                " bites cannot have three equal legs; ask for 4, 7 or 10 bites per set.");
  const int vectors = (bites - 1) / 3;
  if (pattern == "u") return throughCorners({{-1, 0}, {1, 0}, {1, 1}, {-1, 1}}, vectors);
  if (pattern == "z") return throughCorners({{-1, 0}, {1, 0}, {-1, 1}, {1, 1}}, vectors);
  if (pattern == "c") return arc(bites);
  throw Error("There is no pattern '" + pattern + "' to sew; the known ones are u, z and c.");
}

std::vector<std::vector<WallSpot>> planSets(const WallPlan& plan, const SetLayout& layout) {
  const std::vector<Eigen::Vector2d> drawing = patternBites(layout.pattern, layout.bites);
  const double pitch = plan.length() / layout.sets;
  std::vector<std::vector<WallSpot>> sets;
  for (int k = 0; k < layout.sets; ++k) {
    const double begin = pitch * (k + 0.5 * (1 - layout.share));
    sets.emplace_back();
    for (const Eigen::Vector2d& p : drawing)
      sets.back().push_back(plan.at(begin + layout.share * pitch * p.y(), layout.half_width * p.x()));
  }
  return sets;
}

}  // namespace vibe::benchmarks
