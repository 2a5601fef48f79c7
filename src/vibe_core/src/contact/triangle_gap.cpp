#include "contact/triangle_gap.hpp"

#include <BulletCollision/CollisionShapes/btConvexShape.h>
#include <BulletCollision/CollisionShapes/btTriangleShape.h>
#include <BulletCollision/CollisionShapes/btUniformScalingShape.h>
#include <BulletCollision/NarrowPhaseCollision/btGjkPairDetector.h>
#include <BulletCollision/NarrowPhaseCollision/btPointCollector.h>
#include <BulletCollision/NarrowPhaseCollision/btVoronoiSimplexSolver.h>

#include <algorithm>
#include <limits>

#include "contact/bullet_vectors.hpp"
#include "contact/self_contact_distance.hpp"

namespace vibe {

namespace {

using Triangle = std::array<Eigen::Vector3d, 3>;

constexpr double kNoSeparation = 1e-12;  // a shorter vector is rounding error and has no direction [m]

struct Nearest {
  Eigen::Vector3d weight = Eigen::Vector3d::Zero();
  Eigen::Vector3d core = Eigen::Vector3d::Zero();
  Eigen::Vector3d away = Eigen::Vector3d::Zero();  // from the core to the triangle
  double distance2 = std::numeric_limits<double>::infinity();

  void offer(const Eigen::Vector3d& other_weight, const Eigen::Vector3d& other_core,
             const Eigen::Vector3d& other_away) {
    const double other = other_away.squaredNorm();
    if (!(other < distance2)) return;
    weight = other_weight, core = other_core, away = other_away, distance2 = other;
  }
};

void offerEnd(const Eigen::Vector3d& end, const Triangle& t, Nearest& nearest) {
  const TriangleFoot foot = triangleFoot(end, t[0], t[1], t[2]);
  nearest.offer(foot.weight, end, -foot.away);
}

void offerEdge(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Triangle& t, int k, Nearest& nearest) {
  const auto from = static_cast<std::size_t>(k), to = static_cast<std::size_t>((k + 1) % 3);
  const Eigen::Vector3d u = b - a, v = t[to] - t[from], r = a - t[from];
  const double uu = u.squaredNorm(), vv = v.squaredNorm(), uv = u.dot(v), ur = u.dot(r), vr = v.dot(r);
  const double across = uu * vv - uv * uv;
  double s = across > 0 ? std::clamp((uv * vr - ur * vv) / across, 0.0, 1.0) : 0;
  double e = vv > 0 ? (uv * s + vr) / vv : 0;
  if (e < 0 || e > 1 || vv == 0) {  // an edge without length is a point
    e = std::clamp(e, 0.0, 1.0);
    s = uu > 0 ? std::clamp((uv * e - ur) / uu, 0.0, 1.0) : 0;
  }
  Eigen::Vector3d weight = Eigen::Vector3d::Zero();
  weight[k] = 1 - e;
  weight[(k + 1) % 3] = e;
  const Eigen::Vector3d core = a + s * u;
  nearest.offer(weight, core, t[from] + e * v - core);
}

TriangleGap gapOf(const Nearest& nearest) {
  TriangleGap gap;
  gap.weight = nearest.weight;
  gap.core = nearest.core;
  gap.distance = std::sqrt(nearest.distance2);
  if (gap.distance > kNoSeparation)
    gap.normal = nearest.away / gap.distance;
  else
    gap.distance = 0;
  return gap;
}

// Moeller and Trumbore 1997: where the segment pierces the triangle
bool pierces(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Triangle& t, TriangleGap& gap) {
  const Eigen::Vector3d u = b - a, e1 = t[1] - t[0], e2 = t[2] - t[0], p = u.cross(e2);
  const double det = e1.dot(p);
  if (det == 0) return false;
  const Eigen::Vector3d r = a - t[0];
  const double v = r.dot(p) / det;
  if (!(v >= 0 && v <= 1)) return false;
  const Eigen::Vector3d q = r.cross(e1);
  const double w = u.dot(q) / det;
  const double s = e2.dot(q) / det;
  if (!(w >= 0 && v + w <= 1 && s >= 0 && s <= 1)) return false;
  gap.weight = {1 - v - w, v, w};
  gap.core = a + s * u;
  return true;
}

}  // namespace

TriangleGap segmentTriangleGap(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Triangle& triangle) {
  Nearest nearest;
  offerEnd(a, triangle, nearest);
  if (a != b) {
    TriangleGap crossing;
    if (pierces(a, b, triangle, crossing)) return crossing;
    offerEnd(b, triangle, nearest);
    for (int k = 0; k < 3; ++k) offerEdge(a, b, triangle, k, nearest);
  }
  return gapOf(nearest);
}

TriangleGap convexTriangleGap(const btConvexShape& shape, const Triangle& triangle) {
  btVector3 lower, upper;
  shape.getAabb(btTransform::getIdentity(), lower, upper);
  const double scale = kGjkSize / static_cast<double>((upper - lower).length());
  const btUniformScalingShape enlarged(const_cast<btConvexShape*>(&shape), static_cast<btScalar>(scale));
  const btTriangleShape wall(toBullet(triangle[0], scale), toBullet(triangle[1], scale), toBullet(triangle[2], scale));
  const_cast<btTriangleShape&>(wall).setMargin(0);
  btVoronoiSimplexSolver simplex;
  btGjkPairDetector detector(&enlarged, &wall, &simplex, nullptr);
  btGjkPairDetector::ClosestPointInput input;
  input.m_transformA.setIdentity();
  input.m_transformB.setIdentity();
  btPointCollector found;
  detector.getClosestPoints(input, found, nullptr);
  TriangleGap gap;
  const Eigen::Vector3d at = toEigen(found.m_pointInWorld) / scale;
  const double distance = static_cast<double>(found.m_distance) / scale;
  const bool apart = found.m_hasResult && distance > 0;
  gap.weight = triangleFoot(apart ? at : toEigen((lower + upper) / 2), triangle[0], triangle[1], triangle[2]).weight;
  gap.core = gap.weight[0] * triangle[0] + gap.weight[1] * triangle[1] + gap.weight[2] * triangle[2];
  if (!apart) return gap;
  gap.distance = distance;
  gap.normal = -toEigen(found.m_normalOnBInWorld).normalized();
  gap.core -= distance * gap.normal;
  return gap;
}

}  // namespace vibe
