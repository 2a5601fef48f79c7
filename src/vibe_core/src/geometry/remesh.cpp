#include "geometry/remesh.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "geometry/surface_operators.hpp"
#include "vibe_core/geometry/triangle_tree.hpp"
#include "vibe_core/program/error.hpp"

namespace vibe {

namespace {

constexpr int kFewestVertices = 12;
constexpr int kShapingRounds = 12;   // of splits, collapses, flips and relaxation
constexpr int kRelaxingRounds = 15;  // with the final number of vertices
constexpr int kCountRounds = 400;    // limit of the search for the exact number
constexpr int kSplitRounds = 12;     // halvings of an edge within one round

/// One run of remesh().
class Remesher {
 public:
  Remesher(const SurfaceMesh& input, int vertices, const Projection& project)
      : mesh_(input), wanted_(vertices), project_(project), edge_(evenEdge(surfaceArea(input), vertices)) {}

  void shape() {
    splitLong();
    collapseShort();
    flipForValence();
    relax();
    // the thresholds miss the target number by some percent: adjust the edge length accordingly
    edge_ *= std::clamp(std::sqrt(static_cast<double>(mesh_.vertexCount()) / wanted_), 0.9, 1.1);
  }

  void reachCount() {
    for (int round = 0; mesh_.vertexCount() != wanted_; ++round) {
      if (round > kCountRounds) {
        throw Error("remesh: the surface cannot be covered by " + std::to_string(wanted_) + " vertices (it stays at " +
                    std::to_string(mesh_.vertexCount()) + "); ask for more vertices");
      }
      const int missing = wanted_ - mesh_.vertexCount();
      const int budget = (std::abs(missing) + 1) / 2;
      if (missing > 0) {
        splitSome(budget);
      } else {
        collapseSome(budget, round < kCountRounds / 2);
      }
      flipForValence();
      relax();
    }
  }

  void settle() {
    flipForValence();
    relax();
  }

  SurfaceMesh result() const { return mesh_.toMesh(); }

 private:
  /// Edge length of equilateral triangles when this number of vertices covers the area.
  static double evenEdge(double area, int vertices) { return std::sqrt(2.0 * area / (std::sqrt(3.0) * vertices)); }

  std::vector<EditableMesh::Edge> edgesByLength(bool longest_first) const {
    std::vector<std::pair<double, EditableMesh::Edge>> keyed;
    for (const auto& e : mesh_.edges()) keyed.emplace_back(longest_first ? -mesh_.length(e) : mesh_.length(e), e);
    std::sort(keyed.begin(), keyed.end());
    std::vector<EditableMesh::Edge> edges;
    edges.reserve(keyed.size());
    for (const auto& k : keyed) edges.push_back(k.second);
    return edges;
  }

  Eigen::Vector3d middle(const EditableMesh::Edge& e) const {
    return 0.5 * (mesh_.position(e.first) + mesh_.position(e.second));
  }

  bool stillEdge(const EditableMesh::Edge& e) const {
    return mesh_.alive(e.first) && mesh_.alive(e.second) && mesh_.isEdge(e.first, e.second);
  }

  void splitLong() {
    for (int round = 0; round < kSplitRounds; ++round) {
      bool any = false;
      for (const auto& e : edgesByLength(true)) {
        if (mesh_.length(e) <= 4.0 / 3.0 * edge_) break;
        mesh_.split(e.first, e.second, middle(e));
        any = true;
      }
      if (!any) return;
    }
  }

  void collapseShort() {
    for (const auto& e : edgesByLength(false)) {
      if (!stillEdge(e) || mesh_.length(e) >= 4.0 / 5.0 * edge_) continue;
      mesh_.collapse(e.first, e.second, project_(middle(e)), true, 4.0 / 3.0 * edge_);
    }
  }

  /// Splits the longest edges, at most one per triangle neighbourhood.
  void splitSome(int budget) {
    std::vector<bool> touched(mesh_.vertexEnd() + budget, false);
    for (const auto& e : edgesByLength(true)) {
      if (budget == 0) return;
      const auto opposite = mesh_.wings(e.first, e.second);
      const std::array<int, 4> around{e.first, e.second, opposite[0], opposite[1]};
      if (std::any_of(around.begin(), around.end(), [&](int v) { return touched[v]; })) continue;
      touched[mesh_.split(e.first, e.second, project_(middle(e)))] = true;
      for (const int v : around) touched[v] = true;
      --budget;
    }
  }

  void collapseSome(int budget, bool gently) {
    std::vector<bool> touched(mesh_.vertexEnd(), false);
    const double any_length = std::numeric_limits<double>::infinity();
    for (const auto& e : edgesByLength(false)) {
      if (budget == 0) return;
      if (!stillEdge(e) || touched[e.first] || touched[e.second]) continue;
      const auto opposite = mesh_.wings(e.first, e.second);
      if (!mesh_.collapse(e.first, e.second, project_(middle(e)), gently, any_length)) continue;
      for (const int v : {e.first, e.second, opposite[0], opposite[1]}) touched[v] = true;
      --budget;
    }
  }

  void flipForValence() {
    const auto excess = [&](int v, int change) {
      const int d = mesh_.valence(v) + change - 6;
      return d * d;
    };
    for (const auto& [a, b] : mesh_.edges()) {
      if (!mesh_.isEdge(a, b)) continue;
      const auto [c, d] = mesh_.wings(a, b);
      const int before = excess(a, 0) + excess(b, 0) + excess(c, 0) + excess(d, 0);
      const int after = excess(a, -1) + excess(b, -1) + excess(c, 1) + excess(d, 1);
      if (after < before) mesh_.flip(a, b);
    }
  }

  /// Moves every vertex within its tangent plane to the centre of the surrounding triangles, then onto the surface.
  void relax() {
    std::vector<Eigen::Vector3d> moved(mesh_.vertexEnd());
    for (int v = 0; v < mesh_.vertexEnd(); ++v) {
      if (mesh_.alive(v)) moved[v] = project_(tangentialCentre(v));
    }
    for (int v = 0; v < mesh_.vertexEnd(); ++v) {
      if (mesh_.alive(v)) mesh_.move(v, moved[v]);
    }
  }

  Eigen::Vector3d tangentialCentre(int vertex) const {
    const Eigen::Vector3d& x = mesh_.position(vertex);
    Eigen::Vector3d normal = Eigen::Vector3d::Zero(), weighted = Eigen::Vector3d::Zero();
    double total = 0.0;
    for (const int number : mesh_.trianglesAround(vertex)) {
      const Eigen::Vector3d area = mesh_.areaVector(number);
      const auto& t = mesh_.triangle(number);
      const double weight = area.norm();
      weighted += weight * (mesh_.position(t[0]) + mesh_.position(t[1]) + mesh_.position(t[2])) / 3.0;
      total += weight;
      normal += area;
    }
    if (total <= 0.0 || normal.squaredNorm() <= 0.0) return x;
    normal.normalize();
    const Eigen::Vector3d step = weighted / total - x;
    return x + step - normal * normal.dot(step);
  }

  EditableMesh mesh_;
  int wanted_;
  const Projection& project_;
  double edge_;  ///< wanted edge length [m]
};

/// Area-weighted mean edge: the length scale of the visible facets.
double facetEdge(const SurfaceMesh& mesh) {
  double sum = 0.0, total = 0.0;
  for (const auto& t : mesh.triangles) {
    const Eigen::Vector3d &a = mesh.vertices[t[0]], &b = mesh.vertices[t[1]], &c = mesh.vertices[t[2]];
    const double area = (b - a).cross(c - a).norm();
    sum += area * ((b - a).norm() + (c - b).norm() + (a - c).norm()) / 3.0;
    total += area;
  }
  return sum / total;
}

}  // namespace

SurfaceMesh remesh(const SurfaceMesh& input, int vertices, const Projection& project, const Progress& progress) {
  if (vertices < kFewestVertices) {
    throw Error("remesh: " + std::to_string(vertices) + " vertices asked for, at least " +
                std::to_string(kFewestVertices) + " are needed to close a surface");
  }
  const auto report = [&](int done) {
    if (progress) progress("remeshing", static_cast<double>(done) / (kShapingRounds + kRelaxingRounds));
  };
  Remesher remesher(input, vertices, project);
  for (int round = 0; round < kShapingRounds; ++round) {
    report(round);
    remesher.shape();
  }
  remesher.reachCount();
  for (int round = 0; round < kRelaxingRounds; ++round) {
    report(kShapingRounds + round);
    remesher.settle();
  }
  report(kShapingRounds + kRelaxingRounds);
  return remesher.result();
}

SurfaceMesh remeshSurface(const SurfaceMesh& input, int vertices, RemeshReport* report, const Progress& progress) {
  const TriangleTree tree(input);
  SurfaceMesh mesh = remesh(
      input, vertices, [&](const Eigen::Vector3d& p) { return tree.closest(p).point; }, progress);

  // facets wider than the new triangles would be visible as creases
  const double edge = facetEdge(mesh);
  const double ratio = facetEdge(input) / edge;
  const bool coarse = ratio > 1.5;
  if (coarse) {
    smoothTaubin(mesh, 10 + static_cast<int>(std::min(20.0, 2.0 * ratio)));
    offsetToVolume(mesh, enclosedVolume(input));
    const TriangleTree smooth(mesh);
    const Projection project = [&](const Eigen::Vector3d& p) { return smooth.closest(p).point; };
    Remesher remesher(mesh, vertices, project);
    for (int round = 0; round < 3; ++round) remesher.settle();
    mesh = remesher.result();
  }
  offsetToVolume(mesh, enclosedVolume(input));

  if (report) {
    *report = RemeshReport{};
    for (const auto& v : mesh.vertices) {
      const double distance = tree.closest(v).distance;
      report->mean_distance += distance / static_cast<double>(mesh.vertices.size());
      report->max_distance = std::max(report->max_distance, distance);
    }
    report->volume_error = enclosedVolume(mesh) / enclosedVolume(input) - 1.0;
    report->smoothed = coarse;
  }
  return mesh;
}

}  // namespace vibe
