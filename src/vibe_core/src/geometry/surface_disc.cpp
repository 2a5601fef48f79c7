#include "vibe_core/geometry/surface_disc.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>

#include "arithmetic/elementary.hpp"
#include "geometry/triangle_distance.hpp"
#include "vibe_core/geometry/triangle_tree.hpp"

namespace vibe {

namespace {

// Share of the disc below which a vertex takes no part: what is less is rounding.
constexpr double kLeastShare = 1e-9;

double cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return a.x() * b.y() - a.y() * b.x();
}

/// Area and first moment of a part of the plane about the centre of a circle.
struct Moments {
  double area = 0;                                  // [m^2]
  Eigen::Vector2d first = Eigen::Vector2d::Zero();  // [m^3]

  void addTriangle(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {  // with the centre as its third corner
    const double part = 0.5 * cross(a, b);
    area += part;
    first += part / 3 * (a + b);
  }

  void addSector(const Eigen::Vector2d& a, const Eigen::Vector2d& b, double radius) {  // from direction a to b
    const Eigen::Vector2d u = a.normalized(), v = b.normalized();
    area += 0.5 * radius * radius * math::atan2(cross(u, v), u.dot(v));
    first += radius * radius * radius / 3 * Eigen::Vector2d(v.y() - u.y(), u.x() - v.x());
  }

  // What lies between the centre and an edge, inside of the circle.
  void addEdge(const Eigen::Vector2d& a, const Eigen::Vector2d& b, double radius) {
    const Eigen::Vector2d way = b - a;
    const double square = way.squaredNorm(), half = a.dot(way);
    const double root = half * half - square * (a.squaredNorm() - radius * radius);
    if (!(root > 0)) return addSector(a, b, radius);
    const double enter = std::clamp((-half - std::sqrt(root)) / square, 0.0, 1.0);
    const double leave = std::clamp((-half + std::sqrt(root)) / square, 0.0, 1.0);
    const Eigen::Vector2d in = a + enter * way, out = a + leave * way;
    if (enter > 0) addSector(a, in, radius);
    addTriangle(in, out);
    if (leave < 1) addSector(out, b, radius);
  }
};

using Corners = std::array<Eigen::Vector3d, 3>;

Corners cornersOf(const SurfaceMesh& mesh, int triangle) {
  const auto& v = mesh.triangles[triangle];
  return {mesh.vertices[v[0]], mesh.vertices[v[1]], mesh.vertices[v[2]]};
}

/// Integrals of the three hat functions over the part of a triangle within a ball [m^2].
std::array<double, 3> hatIntegrals(const Corners& corner, const Eigen::Vector3d& centre, double radius) {
  const Eigen::Vector3d normal = (corner[1] - corner[0]).cross(corner[2] - corner[0]);
  if (!(normal.squaredNorm() > 0)) return {};
  const Eigen::Vector3d n = normal.normalized(), u = (corner[1] - corner[0]).normalized(), v = n.cross(u);
  const double height = n.dot(corner[0] - centre), circle2 = radius * radius - height * height;
  if (!(circle2 > 0)) return {};
  std::array<Eigen::Vector2d, 3> p;
  for (std::size_t k = 0; k < 3; ++k) p[k] = {u.dot(corner[k] - centre), v.dot(corner[k] - centre)};
  Moments inside;
  for (std::size_t k = 0; k < 3; ++k) inside.addEdge(p[k], p[(k + 1) % 3], std::sqrt(circle2));
  std::array<double, 3> hats;
  for (std::size_t k = 0; k < 3; ++k) {  // the hat of corner k is (cross(a, b) + cross(b - a, point)) / (2 area)
    const Eigen::Vector2d &a = p[(k + 1) % 3], &b = p[(k + 2) % 3];
    hats[k] = (cross(a, b) * inside.area + cross(b - a, inside.first)) / normal.norm();
  }
  return hats;
}

bool shareAnEdge(const std::array<int, 3>& a, const std::array<int, 3>& b) {
  return std::count_if(b.begin(), b.end(), [&](int v) { return hasVertex(a, v); }) >= 2;
}

// Triangles with a point within the radius, each reached from the first over edges.
std::vector<int> trianglesOfDisc(const SurfaceMesh& mesh, int triangle, const Eigen::Vector3d& centre, double radius) {
  std::vector<int> near, disc{triangle};
  for (int t = 0; t < static_cast<int>(mesh.triangles.size()); ++t) {
    if (t == triangle) continue;
    const Corners c = cornersOf(mesh, t);
    if ((closestPointOnTriangle(centre, c[0], c[1], c[2]) - centre).norm() < radius) near.push_back(t);
  }
  for (std::size_t k = 0; k < disc.size(); ++k) {
    const std::array<int, 3> from = mesh.triangles[disc[k]];
    const auto isNext = [&](int t) { return shareAnEdge(from, mesh.triangles[t]); };
    const auto rest = std::stable_partition(near.begin(), near.end(), [&](int t) { return !isNext(t); });
    std::copy(rest, near.end(), std::back_inserter(disc));
    near.erase(rest, near.end());
  }
  return disc;
}

}  // namespace

DiscWeights discWeights(const SurfaceMesh& mesh, int triangle, const Eigen::Vector3d& centre, double radius) {
  std::vector<std::pair<int, double>> parts;
  double area = 0;
  for (int t : trianglesOfDisc(mesh, triangle, centre, radius)) {
    const std::array<double, 3> hats = hatIntegrals(cornersOf(mesh, t), centre, radius);
    for (std::size_t k = 0; k < 3; ++k) parts.emplace_back(mesh.triangles[t][k], hats[k]), area += hats[k];
  }
  std::stable_sort(parts.begin(), parts.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  DiscWeights disc;
  double sum = 0;
  for (std::size_t k = 0; k < parts.size();) {
    const int vertex = parts[k].first;
    double share = 0;
    for (; k < parts.size() && parts[k].first == vertex; ++k) share += parts[k].second / area;
    if (!(share > kLeastShare)) continue;
    disc.vertex.push_back(vertex);
    disc.weight.push_back(share);
    sum += share;
  }
  for (double& weight : disc.weight) weight /= sum;
  return disc;
}

DiscWeights discWeights(const SurfaceMesh& rest, const SurfaceView& now, int triangle, const Eigen::Vector3d& point,
                        double radius) {
  const auto& v = rest.triangles[triangle];
  const Eigen::Vector3d a = now.position(v[0]), ab = now.position(v[1]) - a, ac = now.position(v[2]) - a;
  const Eigen::Vector3d normal = ab.cross(ac);
  const double square = normal.squaredNorm();
  if (!(square > 0)) return discWeights(rest, triangle, rest.vertices[v[0]], radius);
  const double b = (point - a).cross(ac).dot(normal) / square, c = ab.cross(point - a).dot(normal) / square;
  return discWeights(rest, triangle,
                     (1 - b - c) * rest.vertices[v[0]] + b * rest.vertices[v[1]] + c * rest.vertices[v[2]], radius);
}

}  // namespace vibe
