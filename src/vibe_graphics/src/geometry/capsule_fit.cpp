#include "vibe_graphics/geometry/capsule_fit.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>

namespace vibe::graphics {
namespace {

using Eigen::Vector3d;

constexpr int kMaxHalvings = 3;
constexpr double kWorthwhile = 0.6;  // two halves are taken if they have less than this part of the squared distances
constexpr std::size_t kFewest = 4;   // triangles of a part

/// Numbers the places of the corners: equal places have equal numbers.
std::vector<std::uint32_t> placesOf(const std::vector<Eigen::Vector3f>& points) {
  std::map<std::array<float, 3>, std::uint32_t> known;
  std::vector<std::uint32_t> place;
  for (const Eigen::Vector3f& p : points)
    place.push_back(
        known.emplace(std::array{p.x(), p.y(), p.z()}, static_cast<std::uint32_t>(place.size())).first->second);
  return place;
}

std::uint32_t rootOf(std::vector<std::uint32_t>& parent, std::uint32_t k) {
  while (parent[k] != k) k = parent[k] = parent[parent[k]];
  return k;
}

/// A triangle: its area is the weight of its middle, so that the density of the mesh does not matter.
struct Patch {
  Vector3d place;  // [m]
  double area;     // [m^2]
};
using Patches = std::vector<Patch>;

Patch patchOf(const Vector3d& a, const Vector3d& b, const Vector3d& c) {
  return {(a + b + c) / 3, 0.5 * (b - a).cross(c - a).norm()};
}

/// The triangles of each connected part.
std::vector<Patches> partsOf(const std::vector<Eigen::Vector3f>& points, const std::vector<std::uint32_t>& triangles) {
  const std::vector<std::uint32_t> place = placesOf(points);
  std::vector<std::uint32_t> parent(points.size());
  std::iota(parent.begin(), parent.end(), 0U);
  for (std::size_t k = 0; k + 2 < triangles.size(); k += 3)
    for (std::size_t c = 1; c < 3; ++c)
      parent[rootOf(parent, place[triangles[k + c]])] = rootOf(parent, place[triangles[k]]);
  std::map<std::uint32_t, Patches> parts;
  for (std::size_t k = 0; k + 2 < triangles.size(); k += 3) {
    const auto at = [&](std::size_t c) { return Vector3d(points[triangles[k + c]].cast<double>()); };
    const Patch patch = patchOf(at(0), at(1), at(2));
    if (patch.area > 0) parts[rootOf(parent, place[triangles[k]])].push_back(patch);
  }
  std::vector<Patches> result;
  for (auto& [root, patches] : parts)
    if (patches.size() >= kFewest) result.push_back(std::move(patches));
  return result;
}

struct Fit {
  Capsule capsule;
  Vector3d middle = Vector3d::Zero(), axis;
  double squares = 0;  // sum of area times squared distance from the axis [m^4]
};

Fit fitted(const Patches& patches) {
  Fit fit;
  double area = 0;
  for (const Patch& p : patches) fit.middle += p.area * p.place, area += p.area;
  fit.middle /= area;
  Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
  for (const Patch& p : patches) spread += p.area * (p.place - fit.middle) * (p.place - fit.middle).transpose();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(spread);
  fit.axis = solver.eigenvectors().col(2);
  fit.squares = std::max(0.0, solver.eigenvalues()[0] + solver.eigenvalues()[1]);
  double low = 0, high = 0;
  for (const Patch& p : patches) {
    const double along = fit.axis.dot(p.place - fit.middle);
    low = std::min(low, along), high = std::max(high, along);
  }
  const double radius = std::sqrt(fit.squares / area);
  const double rounded = std::min(radius, 0.5 * (high - low));  // the ends are round
  fit.capsule = {fit.middle + (low + rounded) * fit.axis, fit.middle + (high - rounded) * fit.axis, radius};
  return fit;
}

void appendCapsules(const Patches& patches, int halvings, std::vector<Capsule>& capsules) {
  const Fit whole = fitted(patches);
  Patches first, second;
  for (const Patch& p : patches) (whole.axis.dot(p.place - whole.middle) < 0 ? first : second).push_back(p);
  const bool possible = halvings > 0 && first.size() >= kFewest && second.size() >= kFewest;
  if (!possible || fitted(first).squares + fitted(second).squares > kWorthwhile * whole.squares)
    return capsules.push_back(whole.capsule);
  appendCapsules(first, halvings - 1, capsules);
  appendCapsules(second, halvings - 1, capsules);
}

}  // namespace

std::vector<Capsule> fitCapsules(const std::vector<Eigen::Vector3f>& points,
                                 const std::vector<std::uint32_t>& triangles) {
  std::vector<Capsule> capsules;
  for (const Patches& part : partsOf(points, triangles)) appendCapsules(part, kMaxHalvings, capsules);
  return capsules;
}

}  // namespace vibe::graphics
