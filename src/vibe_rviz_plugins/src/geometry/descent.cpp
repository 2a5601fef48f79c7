#include "geometry/descent.hpp"

#include <algorithm>

namespace vibe::rviz_plugins {
namespace {

using Eigen::Vector3d;

constexpr double kStep = 1.2e-3, kShortest = 0.1e-3;  // [m]
constexpr int kSteps = 400;
constexpr double kFlat = 1e-3;  // sine of a slope on which nothing runs
constexpr double kGain = 0.02;  // of the expected loss of height, below which a step was not downhill

}  // namespace

std::vector<WallPlace> steepestDescent(const WallSurface& wall, const WallPlace& start, const Vector3d& down) {
  std::vector<WallPlace> line(1, start);
  double step = kStep;
  while (line.size() <= kSteps && step > kShortest) {
    const WallPlace& here = line.back();
    const Vector3d slope = down - down.dot(here.inward) * here.inward;
    if (!(slope.norm() > kFlat)) break;
    const WallPlace next = wall.moved(here, step * slope.normalized());
    const double lost = (next.place - here.place).dot(down);
    if (lost > kGain * step * slope.norm()) {
      line.push_back(next);
      step = std::min(kStep, 2 * step);
    } else {
      step /= 2;  // the bottom, or a ridge between triangles, is nearer
    }
  }
  return line;
}

std::uint32_t bottomBelow(const WallSurface& wall, std::uint32_t vertex, const Vector3d& down) {
  for (;;) {
    std::uint32_t lowest = vertex;
    for (const std::uint32_t* t = wall.around().begin(vertex); t != wall.around().end(vertex); ++t)
      for (int k = 0; k < 3; ++k) {
        const std::uint32_t other = wall.corners(*t)[k];
        if (wall.places()[other].dot(down) > wall.places()[lowest].dot(down)) lowest = other;
      }
    if (lowest == vertex) return vertex;
    vertex = lowest;
  }
}

std::uint32_t bottomBelow(const WallSurface& wall, const WallPlace& point, const Vector3d& down) {
  std::uint32_t lowest = wall.corners(point.triangle)[0];
  for (int k = 1; k < 3; ++k) {
    const std::uint32_t other = wall.corners(point.triangle)[k];
    if (wall.places()[other].dot(down) > wall.places()[lowest].dot(down)) lowest = other;
  }
  return bottomBelow(wall, lowest, down);
}

}  // namespace vibe::rviz_plugins
