#include "geometry/polygon.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "vibe_core/program/error.hpp"

namespace vibe {

namespace {

constexpr double kOnEdge = 1e-6;   // over the longest edge: a corner so near to an edge of an ear lies on it
constexpr double kNoArea = 1e-12;  // of a polygon over the square of its circumference

double cross2(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return a.x() * b.y() - a.y() * b.x();
}

/// Normal of a polygon, with its area as length (Newell).
Eigen::Vector3d newellNormal(const std::vector<Eigen::Vector3d>& points, const std::vector<int>& corners) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (std::size_t k = 0; k < corners.size(); ++k)
    sum +=
        (points[corners[k]] - points[corners[0]]).cross(points[corners[(k + 1) % corners.size()]] - points[corners[0]]);
  return 0.5 * sum;
}

/// A polygon in its plane from which ears are cut.
class EarCutter {
 public:
  EarCutter(const std::vector<Eigen::Vector3d>& points, const std::vector<int>& corners, const Eigen::Vector3d& normal)
      : corners_(corners), quality_(corners.size()) {
    const Eigen::Vector3d u = normal.unitOrthogonal(), v = normal.normalized().cross(u);
    const int n = static_cast<int>(corners.size());
    for (int k = 0; k < n; ++k) {
      const Eigen::Vector3d p = points[corners[k]] - points[corners[0]];
      plane_.emplace_back(u.dot(p), v.dot(p));
      before_.push_back((k + n - 1) % n);
      after_.push_back((k + 1) % n);
    }
  }

  /// Whether two sides cross in a point that is a corner of neither.
  bool crossesItself() const {
    const std::size_t n = plane_.size();
    const auto apart = [&](std::size_t i, std::size_t j) {  // the ends of side j lie on both sides of side i
      const Eigen::Vector2d &a = plane_[i], &b = plane_[(i + 1) % n], &c = plane_[j], &d = plane_[(j + 1) % n];
      const double slack = kOnEdge * std::max((b - a).squaredNorm(), (d - c).squaredNorm());
      const double from = cross2(b - a, c - a), to = cross2(b - a, d - a);
      return (from > slack && to < -slack) || (from < -slack && to > slack);
    };
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t j = i + 2; j < n; ++j)
        if (apart(i, j) && apart(j, i)) return true;
    return false;
  }

  bool cut(std::vector<std::array<int, 3>>& triangles) {
    int left = static_cast<int>(corners_.size()), at = 0;
    rateAll(at);
    for (; left > 3; --left) {
      int ear = best(at);
      // what blocked an ear may have been cut off meanwhile; the tolerance comes last
      if (quality_[ear] <= 0) rateAll(at), ear = best(at);
      if (quality_[ear] <= 0) tolerance_ = 0, rateAll(at), ear = best(at);
      if (quality_[ear] <= 0) return false;
      triangles.push_back({corners_[before_[ear]], corners_[ear], corners_[after_[ear]]});
      after_[before_[ear]] = after_[ear];
      before_[after_[ear]] = before_[ear];
      at = after_[ear];
      quality_[before_[ear]] = rate(before_[ear]);
      quality_[at] = rate(at);
    }
    triangles.push_back({corners_[before_[at]], corners_[at], corners_[after_[at]]});
    return true;
  }

 private:
  /// Height over the longest edge of the triangle at a corner; 0 if it is no ear.
  double rate(int k) const {
    const Eigen::Vector2d &a = plane_[before_[k]], &b = plane_[k], &c = plane_[after_[k]];
    const double longest = std::max({(b - a).squaredNorm(), (c - b).squaredNorm(), (a - c).squaredNorm()});
    const double height = cross2(b - a, c - a) / longest;
    if (!(height > 1e-12)) return 0;
    const double slack = tolerance_ * longest;
    const auto inside = [&](const Eigen::Vector2d& p) {
      return cross2(b - a, p - a) >= -slack && cross2(c - b, p - b) >= -slack && cross2(a - c, p - c) >= -slack;
    };
    for (int i = after_[after_[k]]; i != before_[k]; i = after_[i]) {
      const Eigen::Vector2d& p = plane_[i];
      if (p != a && p != b && p != c && inside(p)) return 0;
    }
    return height;
  }

  void rateAll(int at) {
    int k = at;
    do quality_[k] = rate(k);
    while ((k = after_[k]) != at);
  }

  int best(int at) const {
    int found = at;
    for (int k = after_[at]; k != at; k = after_[k])
      if (quality_[k] > quality_[found]) found = k;
    return found;
  }

  const std::vector<int>& corners_;
  std::vector<double> quality_;
  std::vector<Eigen::Vector2d> plane_;
  std::vector<int> before_, after_;
  double tolerance_ = kOnEdge;
};

/// Corners without those that repeat the position of the one before.
std::vector<int> distinctCorners(const std::vector<Eigen::Vector3d>& points, const std::vector<int>& corners) {
  std::vector<int> kept;
  for (const int v : corners)
    if (kept.empty() || points[v] != points[kept.back()]) kept.push_back(v);
  while (kept.size() > 1 && points[kept.back()] == points[kept.front()]) kept.pop_back();
  return kept;
}

}  // namespace

bool cutPolygon(const std::vector<Eigen::Vector3d>& points, const std::vector<int>& corners,
                std::vector<std::array<int, 3>>& triangles) {
  const std::vector<int> kept = distinctCorners(points, corners);
  if (kept.size() < 3) return true;
  const Eigen::Vector3d area = newellNormal(points, kept);
  const double size = area.norm();
  double circumference = 0;
  for (std::size_t k = 0; k < kept.size(); ++k)
    circumference += (points[kept[k]] - points[kept[(k + 1) % kept.size()]]).norm();
  if (kept.size() > 3 && std::isfinite(size) && size > kNoArea * circumference * circumference) {
    const std::size_t before = triangles.size();
    EarCutter cutter(points, kept, area / size);
    if (!cutter.crossesItself() && cutter.cut(triangles)) return true;
    triangles.resize(before);
    return false;
  }
  for (std::size_t k = 2; k < kept.size(); ++k) triangles.push_back({kept[0], kept[k - 1], kept[k]});
  return true;
}

void addFaces(const FaceList& faces, int first, const std::string& name, SurfaceMesh& mesh) {
  const auto count = static_cast<std::int64_t>(mesh.vertices.size());
  std::vector<int> corners;
  std::size_t begin = 0;
  for (std::size_t f = 0; f < faces.ends.size(); ++f) {
    const auto place = [&] { return name + " " + std::to_string(faces.places[f]) + ": "; };
    corners.clear();
    for (; begin < faces.ends[f]; ++begin) {
      const std::int64_t v = faces.corners[begin];
      if (v < 0 || v >= count)
        throw Error(place() + "the face names vertex " + std::to_string(v + first) + ", but the file has " +
                    (count == 0 ? "none" : std::to_string(first) + " to " + std::to_string(count - 1 + first)) +
                    "; correct the face, or write the file anew");
      corners.push_back(static_cast<int>(v));
    }
    if (corners.size() > kMaxCorners)
      throw Error(place() + "the face has " + std::to_string(corners.size()) + " corners, more than the " +
                  std::to_string(kMaxCorners) + " that are supported; divide it into triangles");
    if (!cutPolygon(mesh.vertices, corners, mesh.triangles))
      throw Error(place() + "the outline of the face crosses itself; divide the face into triangles");
  }
}

}  // namespace vibe
