#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <array>

namespace vibe {

inline bool hasVertex(const std::array<int, 3>& triangle, int vertex) {
  return triangle[0] == vertex || triangle[1] == vertex || triangle[2] == vertex;
}

/// The point of a triangle nearest to p.
struct TriangleFoot {
  Eigen::Vector3d weight = Eigen::Vector3d::Zero();  ///< barycentric
  Eigen::Vector3d away = Eigen::Vector3d::Zero();    ///< from the foot to p [m]
};

/// Ericson, Real-Time Collision Detection, 5.1.5, with the weights.
inline TriangleFoot triangleFoot(const Eigen::Vector3d& p, const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                                 const Eigen::Vector3d& c) {
  const Eigen::Vector3d ab = b - a, ac = c - a, ap = p - a;
  const double d1 = ab.dot(ap), d2 = ac.dot(ap);
  if (d1 <= 0 && d2 <= 0) return {{1, 0, 0}, ap};
  const Eigen::Vector3d bp = p - b;
  const double d3 = ab.dot(bp), d4 = ac.dot(bp);
  if (d3 >= 0 && d4 <= d3) return {{0, 1, 0}, bp};
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) {
    const double v = d1 / (d1 - d3);
    return {{1 - v, v, 0}, ap - v * ab};
  }
  const Eigen::Vector3d cp = p - c;
  const double d5 = ab.dot(cp), d6 = ac.dot(cp);
  if (d6 >= 0 && d5 <= d6) return {{0, 0, 1}, cp};
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) {
    const double w = d2 / (d2 - d6);
    return {{1 - w, 0, w}, ap - w * ac};
  }
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0) {
    const double w = (d4 - d3) / ((d4 - d3) + (d5 - d6));
    return {{0, 1 - w, w}, bp - w * (c - b)};
  }
  const double scale = 1 / (va + vb + vc), v = vb * scale, w = vc * scale;
  return {{1 - v - w, v, w}, ap - v * ab - w * ac};
}

/// The shortest vector from the segment c, d to the segment a, b (Ericson 5.1.9) [m].
inline Eigen::Vector3d segmentConnection(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c,
                                         const Eigen::Vector3d& d) {
  const Eigen::Vector3d u = b - a, v = d - c, r = a - c;
  const double uu = u.squaredNorm(), vv = v.squaredNorm(), vr = v.dot(r), ur = u.dot(r), uv = u.dot(v);
  if (uu == 0 || vv == 0) {
    const double s = uu > 0 ? std::clamp(-ur / uu, 0.0, 1.0) : 0, t = vv > 0 ? std::clamp(vr / vv, 0.0, 1.0) : 0;
    return r + s * u - t * v;
  }
  const double across = uu * vv - uv * uv;
  double s = across > 0 ? std::clamp((uv * vr - ur * vv) / across, 0.0, 1.0) : 0;
  double t = (uv * s + vr) / vv;
  if (t < 0 || t > 1) {
    t = std::clamp(t, 0.0, 1.0);
    s = std::clamp((uv * t - ur) / uu, 0.0, 1.0);
  }
  return r + s * u - t * v;
}

}  // namespace vibe
