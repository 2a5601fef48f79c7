#include "groups/index_groups.hpp"

#include <BulletCollision/BroadphaseCollision/btDbvt.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <utility>

#include "vibe_core/program/error.hpp"

namespace vibe::prototype {
namespace {

constexpr int kMaxBends = 10;            // halvings of a ray: 1,024 pieces
constexpr btScalar kBoxRadius = 1.001f;  // in radii: covers the error of single precision within 10,000 radii

/// Collects the particles of the leaves that Bullet visits.
struct Candidates : btDbvt::ICollide {
  std::vector<int> particles;
  void Process(const btDbvtNode* leaf) override {
    particles.push_back(static_cast<int>(reinterpret_cast<std::intptr_t>(leaf->data)));
  }
};

/// Intersection of rays with spheres of one radius around particles. Bullet's tree of bounding boxes finds candidates.
/// Because it uses single precision (and absolute tolerances), positions are scaled to radii relative to the first
/// particle, boxes are slightly enlarged, and candidates are tested again in double precision.
class TechniqueRays {
 public:
  TechniqueRays(const std::vector<double>& x, const std::vector<double>& y, const std::vector<double>& z,
                double radius);

  /// Particles whose sphere intersects the straight line between two points, ordered along it.
  std::vector<int> hits(const Eigen::Vector3d& from, const Eigen::Vector3d& to);

  /// The particle whose centre is nearest, and its distance [m].
  int nearest(const Eigen::Vector3d& point, double& distance) const;

  Eigen::Vector3d position(int particle) const { return {x_[particle], y_[particle], z_[particle]}; }
  double radius() const { return radius_; }

 private:
  btVector3 toBullet(const Eigen::Vector3d& point) const;

  const std::vector<double>&x_, &y_, &z_;
  double radius_;
  Eigen::Vector3d origin_;
  btDbvt tree_;
};

TechniqueRays::TechniqueRays(const std::vector<double>& x, const std::vector<double>& y, const std::vector<double>& z,
                             double radius)
    : x_(x), y_(y), z_(z), radius_(radius), origin_(position(0)) {
  const btVector3 half(kBoxRadius, kBoxRadius, kBoxRadius);
  for (std::intptr_t k = 0; k < static_cast<std::intptr_t>(x.size()); ++k)
    tree_.insert(btDbvtVolume::FromCE(toBullet(position(static_cast<int>(k))), half), reinterpret_cast<void*>(k));
}

btVector3 TechniqueRays::toBullet(const Eigen::Vector3d& point) const {
  const Eigen::Matrix<btScalar, 3, 1> p = ((point - origin_) / radius_).cast<btScalar>();
  return {p.x(), p.y(), p.z()};
}

std::vector<int> TechniqueRays::hits(const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
  const btVector3 begin = toBullet(from), end = toBullet(to);
  Candidates found;
  if ((end - begin).length2() > SIMD_EPSILON)
    btDbvt::rayTest(tree_.m_root, begin, end, found);
  else  // Bullet cannot normalise the direction of such a ray
    tree_.collideTV(tree_.m_root, btDbvtVolume::FromCR(begin, 0), found);

  const Eigen::Vector3d direction = to - from;
  const double square = direction.squaredNorm();
  std::vector<std::pair<double, int>> order;
  for (const int k : found.particles) {
    const double along = square > 0 ? std::clamp((position(k) - from).dot(direction) / square, 0.0, 1.0) : 0;
    if ((from + along * direction - position(k)).squaredNorm() <= radius_ * radius_) order.emplace_back(along, k);
  }
  std::sort(order.begin(), order.end());
  std::vector<int> result;
  for (const auto& hit : order) result.push_back(hit.second);
  return result;
}

int TechniqueRays::nearest(const Eigen::Vector3d& point, double& distance) const {
  int best = 0;
  double min = std::numeric_limits<double>::infinity();
  for (int k = 0; k < static_cast<int>(x_.size()); ++k) {
    const double square = (position(k) - point).squaredNorm();
    if (square < min) min = square, best = k;
  }
  distance = std::sqrt(min);
  return best;
}

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

}  // namespace vibe::prototype
