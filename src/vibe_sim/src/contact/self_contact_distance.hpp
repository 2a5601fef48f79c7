#pragma once

#include <Eigen/Geometry>

namespace vibe {

/// The point of a triangle nearest to p.
struct TriangleFoot {
  Eigen::Vector3d weight = Eigen::Vector3d::Zero();  ///< barycentric
  Eigen::Vector3d away = Eigen::Vector3d::Zero();    ///< from the foot to p [m]
  bool inside;                                       ///< of the triangle, not on its edge
};

/// Ericson, Real-Time Collision Detection, 5.1.5, with the weights.
inline TriangleFoot triangleFoot(const Eigen::Vector3d& p, const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                                 const Eigen::Vector3d& c) {
  const Eigen::Vector3d ab = b - a, ac = c - a, ap = p - a;
  const double d1 = ab.dot(ap), d2 = ac.dot(ap);
  if (d1 <= 0 && d2 <= 0) return {{1, 0, 0}, ap, false};
  const Eigen::Vector3d bp = p - b;
  const double d3 = ab.dot(bp), d4 = ac.dot(bp);
  if (d3 >= 0 && d4 <= d3) return {{0, 1, 0}, bp, false};
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) {
    const double v = d1 / (d1 - d3);
    return {{1 - v, v, 0}, ap - v * ab, false};
  }
  const Eigen::Vector3d cp = p - c;
  const double d5 = ab.dot(cp), d6 = ac.dot(cp);
  if (d6 >= 0 && d5 <= d6) return {{0, 0, 1}, cp, false};
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) {
    const double w = d2 / (d2 - d6);
    return {{1 - w, 0, w}, ap - w * ac, false};
  }
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0) {
    const double w = (d4 - d3) / ((d4 - d3) + (d5 - d6));
    return {{0, 1 - w, w}, bp - w * (c - b), false};
  }
  const double scale = 1 / (va + vb + vc), v = vb * scale, w = vc * scale;
  return {{1 - v - w, v, w}, ap - v * ab - w * ac, true};
}

/// Distance from a wall, negative where p has passed to its other side [m], and the way out of it.
struct SignedDistance {
  double value;
  Eigen::Vector3d apart;  ///< unit gradient of the value by p; zero where there is none
};

/// @param side  1: p belongs where the normal of a, b, c points; -1: to the other side
inline SignedDistance signedDistance(const TriangleFoot& foot, double side, const Eigen::Vector3d& a,
                                     const Eigen::Vector3d& b, const Eigen::Vector3d& c) {
  const double distance = foot.away.norm();
  if (!foot.inside) return {distance, distance > 0 ? foot.away / distance : Eigen::Vector3d::Zero().eval()};
  const Eigen::Vector3d normal = side * (b - a).cross(c - a).normalized();
  return {normal.dot(foot.away) < 0 ? -distance : distance, normal};
}

}  // namespace vibe
