#include "self_contact/surface_walls.hpp"

#include <algorithm>
#include <functional>
#include <limits>
#include <queue>
#include <utility>

namespace vibe {

namespace {

/// Dijkstra's shortest paths along edges from a vertex, as far as a reach.
class NearVertices {
 public:
  NearVertices(const SurfaceMesh& mesh, double reach)
      : mesh_(mesh),
        reach_(reach),
        neighbours_(vertexNeighbours(mesh)),
        length_(mesh.vertices.size(), std::numeric_limits<double>::infinity()) {}

  /// The vertices within the reach, or within two edges, ascending.
  const std::vector<int>& of(int vertex) {
    search(vertex);
    for (const int v : found_) length_[v] = std::numeric_limits<double>::infinity();
    for (const int v : neighbours_[vertex]) {
      found_.push_back(v);
      found_.insert(found_.end(), neighbours_[v].begin(), neighbours_[v].end());
    }
    std::sort(found_.begin(), found_.end());
    found_.erase(std::unique(found_.begin(), found_.end()), found_.end());
    return found_;
  }

 private:
  using Entry = std::pair<double, int>;

  void search(int vertex) {
    length_[vertex] = 0;
    queue_.push({0, vertex});
    found_.assign(1, vertex);
    while (!queue_.empty()) {
      const auto [far, v] = queue_.top();
      queue_.pop();
      if (far > length_[v]) continue;
      for (const int w : neighbours_[v]) {
        const double there = far + (mesh_.vertices[v] - mesh_.vertices[w]).norm();
        if (there > reach_ || there >= length_[w]) continue;
        if (length_[w] == std::numeric_limits<double>::infinity()) found_.push_back(w);
        length_[w] = there;
        queue_.push({there, w});
      }
    }
  }

  const SurfaceMesh& mesh_;
  double reach_;
  std::vector<std::vector<int>> neighbours_;
  std::vector<double> length_;
  std::vector<int> found_;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<Entry>> queue_;
};

}  // namespace

SurfaceWalls::SurfaceWalls(const SurfaceMesh& rest, double reach) : start_(1, 0) {
  NearVertices near(rest, reach);
  for (int i = 0; i < static_cast<int>(rest.vertices.size()); ++i) {
    const std::vector<int>& vertices = near.of(i);
    wall_.insert(wall_.end(), vertices.begin(), vertices.end());
    start_.push_back(static_cast<int>(wall_.size()));
  }
}

}  // namespace vibe
