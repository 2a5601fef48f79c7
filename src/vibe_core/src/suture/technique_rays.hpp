#pragma once
#include <BulletCollision/BroadphaseCollision/btDbvt.h>

#include <Eigen/Core>
#include <vector>

namespace vibe {

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

}  // namespace vibe
