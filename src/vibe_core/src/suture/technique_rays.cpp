#include "suture/technique_rays.hpp"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <utility>

namespace vibe {
namespace {

constexpr btScalar kBoxRadius = 1.001f;  // in radii: covers the error of single precision within 10,000 radii

/// Collects the particles of the leaves that Bullet visits.
struct Candidates : btDbvt::ICollide {
  std::vector<int> particles;
  void Process(const btDbvtNode* leaf) override {
    particles.push_back(static_cast<int>(reinterpret_cast<std::intptr_t>(leaf->data)));
  }
};

}  // namespace

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

}  // namespace vibe
