#include "suture/index_groups.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "suture/technique_rays.hpp"
#include "vibe_core/common/error.hpp"

namespace vibe {
namespace {

constexpr int kMaxBends = 10;  // halvings of a ray: 1,024 pieces

using Ray = std::pair<Eigen::Vector3d, Eigen::Vector3d>;

bool allFinite(const std::vector<double>& values) {
  return std::all_of(values.begin(), values.end(), [](double v) { return std::isfinite(v); });
}

void checkBites(const ParticlePositions& p, const std::vector<Eigen::Vector3d>& bites,
                const IndexGroupSettings& settings) {
  if (p.x.empty() || p.y.size() != p.x.size() || p.z.size() != p.x.size())
    throw Error("Index groups need x, y and z of the same particles, at least one, not " + std::to_string(p.x.size()) +
                ", " + std::to_string(p.y.size()) + " and " + std::to_string(p.z.size()) +
                "; pass the state's arrays.");
  if (!allFinite(p.x) || !allFinite(p.y) || !allFinite(p.z))
    throw Error("A particle's position is not finite; index groups need positions of a state that is still sound.");
  for (std::size_t k = 0; k < bites.size(); ++k)
    if (!bites[k].allFinite())
      throw Error("Bite " + std::to_string(k + 1) + " has a position that is not finite; leave it out.");
  if (!(settings.ray_radius > 0) || !std::isfinite(settings.ray_radius))
    throw Error("ray_radius of the index groups must be above 0 m; pass half the distance of neighbouring particles.");
  if (settings.particle_limit < 1) throw Error("particle_limit of the index groups must be 1 or more.");
}

/// Bites at the corners of a U or Z.
std::pair<Eigen::Vector3d, Eigen::Vector3d> corners(const std::vector<Eigen::Vector3d>& bites,
                                                    const TechniqueResult& technique) {
  const int count = static_cast<int>(bites.size());
  const auto [first, second] = technique.transitions;
  if (first < 0 || second <= first || second + 1 >= count)
    throw Error("A technique '" + std::string(toString(technique.technique)) + "' of " + std::to_string(count) +
                " bites with transitions " + std::to_string(first) + " and " + std::to_string(second) +
                " has no two corners; pass the result of recogniseTechnique() for these bites.");
  return {bites[first + 1], bites[second + 1]};
}

std::vector<Ray> raysOf(const std::vector<Eigen::Vector3d>& bites, const TechniqueResult& technique, bool whole_legs) {
  if (technique.technique == Technique::Z) {
    const auto [first, second] = corners(bites, technique);
    return {{bites.front(), second}, {first, bites.back()}};
  }
  if (technique.technique == Technique::U) {
    const auto [first, second] = corners(bites, technique);
    if (whole_legs) return {{bites.front(), first}, {second, bites.back()}};
    return {{bites[0], bites[1]}, {first, second}};
  }
  std::vector<Ray> rays;
  for (std::size_t k = 1; k < bites.size(); ++k) rays.emplace_back(bites[k - 1], bites[k]);
  return rays;
}

/// Appends the particles that a ray hits. A ray that leaves the wall is bent onto it. On a flat wall the middle of a
/// ray can lie in a gap between particles, so the threshold distance for the whole ray is larger; parts of a bent ray
/// are known to lie on a curve.
void collect(TechniqueRays& rays, const Ray& ray, int bends_left, std::vector<int>& group) {
  const Eigen::Vector3d middle = (ray.first + ray.second) / 2;
  double distance;
  const int nearest = rays.nearest(middle, distance);
  const Eigen::Vector3d over = rays.position(nearest);
  const double half = (ray.second - ray.first).norm() / 2;
  // a bend at least one chord length away from an end is invalid: there is no wall between the ends
  const bool leads = std::max((over - ray.first).norm(), (over - ray.second).norm()) < 2 * half;
  if (bends_left > 0 && distance > (bends_left == kMaxBends ? 2 : 1) * rays.radius() && leads) {
    collect(rays, {ray.first, over}, bends_left - 1, group);
    collect(rays, {over, ray.second}, bends_left - 1, group);
    return;
  }
  const std::vector<int> hits = rays.hits(ray.first, ray.second);
  group.insert(group.end(), hits.begin(), hits.end());
}

}  // namespace

std::vector<std::vector<int>> indexGroups(const ParticlePositions& particles, const std::vector<Eigen::Vector3d>& bites,
                                          const TechniqueResult& technique, const IndexGroupSettings& settings) {
  checkBites(particles, bites, settings);
  const bool limited = technique.technique != Technique::U && technique.technique != Technique::Z;
  TechniqueRays rays(particles.x, particles.y, particles.z, settings.ray_radius);
  std::vector<char> taken(particles.x.size(), 0);
  std::vector<std::vector<int>> groups;
  for (const Ray& ray : raysOf(bites, technique, settings.whole_legs)) {
    std::vector<int> met, group;
    collect(rays, ray, settings.follow_wall ? kMaxBends : 0, met);
    double distance;
    if (met.empty()) met.push_back(rays.nearest(ray.first, distance));
    for (const int k : met) {
      if (taken[k] != 0) continue;
      if (limited && static_cast<int>(group.size()) >= settings.particle_limit) break;
      taken[k] = 1;
      group.push_back(k);
    }
    groups.push_back(std::move(group));
  }
  return groups;
}

Eigen::Vector3d middleOf(const std::vector<Eigen::Vector3d>& bites) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const auto& bite : bites) sum += bite;
  return bites.empty() ? sum : Eigen::Vector3d(sum / static_cast<double>(bites.size()));
}

}  // namespace vibe
