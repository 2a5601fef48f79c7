#include "geometry/landmark_estimate.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <limits>
#include <queue>
#include <utility>

#include "vibe_core/common/error.hpp"

namespace vibe {

namespace {

constexpr double kOesophagusShare = 1.0 / 3;  // of the way from the fundus to the pylorus
constexpr double kMinLesserCurvature = 0.02;

struct Paths {
  std::vector<double> distance;  // from the source along edges [m]
  std::vector<int> previous;
};

Paths shortestPaths(const SurfaceMesh& mesh, int source) {
  const auto neighbours = vertexNeighbours(mesh);
  Paths paths{std::vector<double>(mesh.vertices.size(), std::numeric_limits<double>::infinity()),
              std::vector<int>(mesh.vertices.size(), -1)};
  using Entry = std::pair<double, int>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
  paths.distance[source] = 0;
  queue.push({0, source});
  while (!queue.empty()) {
    const auto [distance, v] = queue.top();
    queue.pop();
    if (distance > paths.distance[v]) continue;
    for (int n : neighbours[v]) {
      const double d = distance + (mesh.vertices[n] - mesh.vertices[v]).norm();
      if (d >= paths.distance[n]) continue;
      paths.distance[n] = d;
      paths.previous[n] = v;
      queue.push({d, n});
    }
  }
  return paths;
}

Eigen::Vector3d farthestFromChord(const SurfaceMesh& mesh, const std::vector<int>& path, std::size_t from) {
  const Eigen::Vector3d start = mesh.vertices[path[from]];
  const Eigen::Vector3d chord = (mesh.vertices[path.back()] - start).normalized();
  int best = path[from];
  double farthest = -1;
  for (std::size_t k = from; k < path.size(); ++k) {
    const double distance = (mesh.vertices[path[k]] - start).cross(chord).norm();
    if (distance > farthest) {
      farthest = distance;
      best = path[k];
    }
  }
  return mesh.vertices[best];
}

}  // namespace

Landmarks estimateLandmarks(const SurfaceMesh& surface) {
  const auto lower = [](const Eigen::Vector3d& a, const Eigen::Vector3d& b) { return a.z() < b.z(); };
  const auto top = std::max_element(surface.vertices.begin(), surface.vertices.end(), lower);
  const int fundus = static_cast<int>(top - surface.vertices.begin());
  const Paths paths = shortestPaths(surface, fundus);
  const auto farthest = std::max_element(paths.distance.begin(), paths.distance.end());
  const int pylorus = static_cast<int>(farthest - paths.distance.begin());

  std::vector<int> path;
  for (int v = pylorus; v >= 0; v = paths.previous[v]) path.push_back(v);
  std::reverse(path.begin(), path.end());  // from the fundus to the pylorus
  std::size_t oesophagus = 0;
  while (paths.distance[path[oesophagus]] < kOesophagusShare * *farthest) ++oesophagus;

  Landmarks landmarks;
  landmarks.fundus = surface.vertices[fundus];
  landmarks.pylorus = surface.vertices[pylorus];
  landmarks.oesophagus = surface.vertices[path[oesophagus]];
  landmarks.incisura = farthestFromChord(surface, path, oesophagus);
  if ((landmarks.oesophagus - landmarks.pylorus).norm() < kMinLesserCurvature)
    throw Error("The surface is too small or too round for a stomach, its landmarks cannot be guessed; state them.");
  return landmarks;
}

}  // namespace vibe
