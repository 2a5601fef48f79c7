#include "vibe_core/geometry/surface_mesh.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include <Eigen/Geometry>

#include "arithmetic/elementary.hpp"
#include "vibe_core/program/error.hpp"

namespace vibe {

namespace {

/// Normal of a triangle with the length of twice its area.
Eigen::Vector3d doubledAreaVector(const SurfaceMesh& mesh, const std::array<int, 3>& triangle) {
  const Eigen::Vector3d& a = mesh.vertices[triangle[0]];
  return (mesh.vertices[triangle[1]] - a).cross(mesh.vertices[triangle[2]] - a);
}

/// Twice the area that a triangle has with the origin, seen from above; positive: p, q turn to the left.
double doubledAreaFromAbove(const Eigen::Vector3d& p, const Eigen::Vector3d& q) {
  return p.x() * q.y() - p.y() * q.x();
}

/// Whether an edge passes the ray from the origin along x, seen from above: 1 to the left, -1 to the right, 0: not. An
/// end counts as to the right, and an edge through the origin does not pass, so that triangles with common edges and
/// vertices share the plane without gaps.
int crossing(const Eigen::Vector3d& p, const Eigen::Vector3d& q) {
  if ((p.y() > 0) == (q.y() > 0)) return 0;
  const double side = doubledAreaFromAbove(p, q);
  return q.y() > 0 ? (side > 0 ? 1 : 0) : (side < 0 ? -1 : 0);
}

}  // namespace

double enclosedVolume(const SurfaceMesh& mesh) {
  if (mesh.vertices.empty()) return 0.0;
  // relative to a vertex of the mesh: far from the origin the tetrahedra would be large and cancel badly
  const Eigen::Vector3d origin = mesh.vertices.front();
  double sum = 0.0;
  for (const auto& t : mesh.triangles) {
    const Eigen::Vector3d a = mesh.vertices[t[0]] - origin;
    const Eigen::Vector3d b = mesh.vertices[t[1]] - origin;
    const Eigen::Vector3d c = mesh.vertices[t[2]] - origin;
    sum += a.dot(b.cross(c));
  }
  return sum / 6.0;
}

bool isWithin(const SurfaceView& surface, const Eigen::Vector3d& point) {
  int winding = 0;  // triangles above the point that face upwards, less those that face downwards
  for (const auto& t : surface.triangles) {
    const Eigen::Vector3d a = surface.position(t[0]) - point, b = surface.position(t[1]) - point,
                          c = surface.position(t[2]) - point;
    const int turns = crossing(a, b) + crossing(b, c) + crossing(c, a);  // 1 or -1: the point is above or below it
    if (turns == 0) continue;
    const double height = a.z() * doubledAreaFromAbove(b, c) + b.z() * doubledAreaFromAbove(c, a) +
                          c.z() * doubledAreaFromAbove(a, b);  // times its area from above
    if (turns * height > 0) winding += turns;
  }
  return winding > 0;
}

double surfaceArea(const SurfaceMesh& mesh) {
  double sum = 0.0;
  for (const auto& t : mesh.triangles) sum += doubledAreaVector(mesh, t).norm();
  return sum / 2.0;
}

std::vector<double> vertexAreas(const SurfaceMesh& mesh) {
  std::vector<double> areas(mesh.vertices.size(), 0.0);
  for (const auto& t : mesh.triangles) {
    const double third = doubledAreaVector(mesh, t).norm() / 6.0;
    for (const int v : t) areas[v] += third;
  }
  return areas;
}

std::vector<Eigen::Vector3d> vertexNormals(const SurfaceMesh& mesh) {
  std::vector<Eigen::Vector3d> normals(mesh.vertices.size(), Eigen::Vector3d::Zero());
  for (const auto& t : mesh.triangles) {
    const Eigen::Vector3d n = doubledAreaVector(mesh, t);
    for (const int v : t) normals[v] += n;
  }
  for (auto& n : normals) {
    const double length = n.norm();
    if (length > 0.0) n /= length;
  }
  return normals;
}

std::vector<std::vector<int>> vertexNeighbours(const SurfaceMesh& mesh) {
  constexpr std::size_t kUsual = 12;  // six neighbours, each of two triangles
  std::vector<std::vector<int>> neighbours(mesh.vertices.size());
  for (auto& list : neighbours) list.reserve(kUsual);
  for (const auto& t : mesh.triangles) {
    for (int k = 0; k < 3; ++k) {
      neighbours[t[k]].push_back(t[(k + 1) % 3]);
      neighbours[t[k]].push_back(t[(k + 2) % 3]);
    }
  }
  for (auto& list : neighbours) {
    std::sort(list.begin(), list.end());
    list.erase(std::unique(list.begin(), list.end()), list.end());
  }
  return neighbours;
}

namespace {

using Edge = std::pair<int, int>;

Edge makeEdge(int a, int b) {
  return a < b ? Edge(a, b) : Edge(b, a);
}

/// Data of Loop's rule for a new vertex: its number, and the vertices opposite the edge.
struct EdgeVertex {
  int number = 0;
  std::array<int, 2> opposite{-1, -1};
};

std::map<Edge, EdgeVertex> findEdges(const SurfaceMesh& mesh) {
  std::map<Edge, EdgeVertex> edges;
  for (const auto& t : mesh.triangles) {
    for (int k = 0; k < 3; ++k) {
      EdgeVertex& e = edges[makeEdge(t[k], t[(k + 1) % 3])];
      const int opposite = t[(k + 2) % 3];
      if (e.opposite[0] < 0) {
        e.opposite[0] = opposite;
      } else if (e.opposite[1] < 0) {
        e.opposite[1] = opposite;
      } else {
        throw Error("makeLoopSubdivision: an edge at vertex " + std::to_string(t[k]) +
                    " has more than two triangles; check the surface with checkSurface() first");
      }
    }
  }
  int next = static_cast<int>(mesh.vertices.size());
  for (auto& [edge, e] : edges) {
    if (e.opposite[1] < 0) {
      throw Error("makeLoopSubdivision: the surface is open at the edge from vertex " + std::to_string(edge.first) +
                  " to " + std::to_string(edge.second) + "; close it first");
    }
    e.number = next++;
  }
  return edges;
}

void addWeight(RenderSurface& render_surface, int particle, double weight) {
  render_surface.particles.push_back(particle);
  render_surface.weights.push_back(static_cast<float>(weight));
}

/// Loop's rule for an old vertex of valence n, beta as in Loop's thesis (1987).
void addOldVertex(RenderSurface& render_surface, int vertex, const std::vector<int>& neighbours) {
  const double n = static_cast<double>(neighbours.size());
  if (neighbours.empty()) {
    addWeight(render_surface, vertex, 1.0);
  } else {
    const double c = 3.0 / 8.0 + math::cos(2.0 * M_PI / n) / 4.0;
    const double beta = (5.0 / 8.0 - c * c) / n;
    addWeight(render_surface, vertex, 1.0 - n * beta);
    for (const int k : neighbours) addWeight(render_surface, k, beta);
  }
  render_surface.offsets.push_back(static_cast<int>(render_surface.particles.size()));
}

void addNewVertex(RenderSurface& render_surface, const Edge& edge, const EdgeVertex& e) {
  addWeight(render_surface, edge.first, 3.0 / 8.0);
  addWeight(render_surface, edge.second, 3.0 / 8.0);
  addWeight(render_surface, e.opposite[0], 1.0 / 8.0);
  addWeight(render_surface, e.opposite[1], 1.0 / 8.0);
  render_surface.offsets.push_back(static_cast<int>(render_surface.particles.size()));
}

}  // namespace

RenderSurface makeLoopSubdivision(const SurfaceMesh& particles) {
  const std::map<Edge, EdgeVertex> edges = findEdges(particles);
  const auto neighbours = vertexNeighbours(particles);
  RenderSurface render_surface;
  render_surface.offsets.push_back(0);
  for (int v = 0; v < static_cast<int>(particles.vertices.size()); ++v) addOldVertex(render_surface, v, neighbours[v]);
  for (const auto& [edge, e] : edges) addNewVertex(render_surface, edge, e);  // in the order of their numbers
  for (const auto& t : particles.triangles) {
    const int ab = edges.at(makeEdge(t[0], t[1])).number;
    const int bc = edges.at(makeEdge(t[1], t[2])).number;
    const int ca = edges.at(makeEdge(t[2], t[0])).number;
    render_surface.triangles.push_back({t[0], ab, ca});
    render_surface.triangles.push_back({t[1], bc, ab});
    render_surface.triangles.push_back({t[2], ca, bc});
    render_surface.triangles.push_back({ab, bc, ca});
  }
  return render_surface;
}

std::vector<Eigen::Vector3d> renderPositions(const RenderSurface& render_surface,
                                             const std::vector<Eigen::Vector3d>& particles) {
  const int count = render_surface.offsets.empty() ? 0 : static_cast<int>(render_surface.offsets.size()) - 1;
  std::vector<Eigen::Vector3d> positions(count, Eigen::Vector3d::Zero());
  for (int v = 0; v < count; ++v) {
    for (int k = render_surface.offsets[v]; k < render_surface.offsets[v + 1]; ++k) {
      positions[v] += static_cast<double>(render_surface.weights[k]) * particles[render_surface.particles[k]];
    }
  }
  return positions;
}

}  // namespace vibe
