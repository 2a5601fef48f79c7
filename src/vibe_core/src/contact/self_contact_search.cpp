#include "contact/self_contact_search.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <queue>
#include <utility>

#include "contact/self_contact_distance.hpp"

namespace vibe {

namespace {

/// Distance between the parts of two triangles at one vertex that do not contain it [m].
double fanDistance(std::array<int, 3> a, std::array<int, 3> b, const std::vector<Eigen::Vector3d>& at) {
  for (std::array<int, 3>* t : {&a, &b}) {
    const std::array<int, 3>& other = t == &a ? b : a;
    while (std::find(other.begin(), other.end(), (*t)[0]) == other.end())
      std::rotate(t->begin(), t->begin() + 1, t->end());
  }
  const auto connect = [&](int p, const std::array<int, 3>& t) {
    return triangleFoot(at[p], at[t[0]], at[t[1]], at[t[2]]).away.squaredNorm();
  };
  double least = std::min(std::min(connect(a[1], b), connect(a[2], b)), std::min(connect(b[1], a), connect(b[2], a)));
  for (int k = 0; k < 3; ++k) {
    least = std::min(least, segmentConnection(at[a[1]], at[a[2]], at[b[k]], at[b[(k + 1) % 3]]).squaredNorm());
    least = std::min(least, segmentConnection(at[b[1]], at[b[2]], at[a[k]], at[a[(k + 1) % 3]]).squaredNorm());
  }
  return std::sqrt(least);
}

}  // namespace

SelfContactSearch::SelfContactSearch(const SurfaceMesh& rest, const std::vector<double>& one_wall)
    : triangles_(rest.triangles), tree_(rest) {
  const std::size_t n = rest.vertices.size();
  triangle_start_.assign(n + 1, 0);
  for (const auto& t : triangles_)
    for (const int v : t) ++triangle_start_[v + 1];
  for (std::size_t i = 0; i < n; ++i) triangle_start_[i + 1] += triangle_start_[i];
  triangle_of_.resize(3 * triangles_.size());
  std::vector<int> next(triangle_start_.begin(), triangle_start_.end() - 1);
  for (std::size_t t = 0; t < triangles_.size(); ++t)
    for (const int v : triangles_[t]) triangle_of_[next[v]++] = static_cast<int>(t);
  joinWalls(rest, one_wall);
}

// Dijkstra's shortest paths along edges from every vertex, and all vertices within two edges.
void SelfContactSearch::joinWalls(const SurfaceMesh& rest, const std::vector<double>& one_wall) {
  const auto neighbours = vertexNeighbours(rest);
  const int n = static_cast<int>(rest.vertices.size());
  std::vector<double> length(n, std::numeric_limits<double>::infinity());
  std::vector<int> touched;
  using Entry = std::pair<double, int>;
  wall_start_.assign(1, 0);
  for (int i = 0; i < n; ++i) {
    std::priority_queue<Entry, std::vector<Entry>, std::greater<Entry>> queue;
    length[i] = 0;
    queue.push({0, i});
    touched.assign(1, i);
    while (!queue.empty()) {
      const auto [far, v] = queue.top();
      queue.pop();
      if (far > length[v]) continue;
      for (const int w : neighbours[v]) {
        const double there = far + (rest.vertices[v] - rest.vertices[w]).norm();
        if (there > one_wall[i] || there >= length[w]) continue;
        if (std::isinf(length[w])) touched.push_back(w);
        length[w] = there;
        queue.push({there, w});
      }
    }
    for (const int v : touched) length[v] = std::numeric_limits<double>::infinity();
    for (const int v : neighbours[i]) {
      touched.push_back(v);
      touched.insert(touched.end(), neighbours[v].begin(), neighbours[v].end());
    }
    std::sort(touched.begin(), touched.end());
    touched.erase(std::unique(touched.begin(), touched.end()), touched.end());
    wall_.insert(wall_.end(), touched.begin(), touched.end());
    wall_start_.push_back(static_cast<int>(wall_.size()));
  }
}

bool SelfContactSearch::oneWall(int vertex, int other) const {
  return std::binary_search(wall_.begin() + wall_start_[vertex], wall_.begin() + wall_start_[vertex + 1], other);
}

void SelfContactSearch::findNear(const std::vector<Eigen::Vector3d>& positions, double distance, double slack,
                                 float cosine, std::vector<Near>& found) {
  found.clear();
  tree_.enclose(positions, positions, 0.5 * distance, slack, true);
  tree_.visitFacing(cosine, [&](int one, int other) {
    addNear(one, other, positions, distance + 2 * slack, found);
    addNear(other, one, positions, distance + 2 * slack, found);
  });
  std::sort(found.begin(), found.end());
}

// Each vertex belongs to the first of its triangles.
void SelfContactSearch::addNear(int owner, int triangle, const std::vector<Eigen::Vector3d>& positions, double distance,
                                std::vector<Near>& found) const {
  const auto& n = triangles_[triangle];
  for (const int v : triangles_[owner]) {
    if (triangle_of_[triangle_start_[v]] != owner) continue;
    const TriangleFoot foot = triangleFoot(positions[v], positions[n[0]], positions[n[1]], positions[n[2]]);
    if (!(foot.away.squaredNorm() < distance * distance)) continue;
    if (!oneWall(v, n[0]) && !oneWall(v, n[1]) && !oneWall(v, n[2])) found.push_back({v, triangle});
  }
}

// By a plane parallel to one of the triangles or between their centres, all the time.
bool SelfContactSearch::apart(int one, int other, const std::vector<Eigen::Vector3d>& start,
                              const std::vector<Eigen::Vector3d>& end, double distance) const {
  const std::array<int, 3>&a = triangles_[one], &b = triangles_[other];
  const auto separates = [&](const Eigen::Vector3d& direction, const std::vector<Eigen::Vector3d>& at) {
    const double p = direction.dot(at[a[0]]), q = direction.dot(at[a[1]]), r = direction.dot(at[a[2]]),
                 s = direction.dot(at[b[0]]), t = direction.dot(at[b[1]]), u = direction.dot(at[b[2]]);
    const double gap = distance * direction.norm();
    if (std::min({p, q, r}) - std::max({s, t, u}) > gap) return 1;
    return std::min({s, t, u}) - std::max({p, q, r}) > gap ? -1 : 0;
  };
  const auto normal = [&](const std::array<int, 3>& t) -> Eigen::Vector3d {
    return (start[t[1]] - start[t[0]]).cross(start[t[2]] - start[t[0]]);
  };
  const Eigen::Vector3d between = (start[a[0]] + start[a[1]] + start[a[2]]) - (start[b[0]] + start[b[1]] + start[b[2]]);
  for (const Eigen::Vector3d& direction : {between, normal(a), normal(b)}) {
    const int side = separates(direction, start);
    if (side != 0 && (&start == &end || separates(direction, end) == side)) return true;
  }
  return false;
}

void SelfContactSearch::findMeetings(const std::vector<Eigen::Vector3d>& start, const std::vector<Eigen::Vector3d>& end,
                                     double floor, double slack, std::vector<std::array<int, 2>>& found) {
  found.clear();
  tree_.enclose(start, end, 0.5 * floor, slack, false);
  tree_.visitCrossing([&](int one, int other) {
    int shared = 0;
    for (const int v : triangles_[one])
      for (const int w : triangles_[other]) shared += v == w ? 1 : 0;
    if ((shared == 1 && (slack == 0 || fanDistance(triangles_[one], triangles_[other], start) < floor + 2 * slack)) ||
        (shared == 0 && !apart(one, other, start, end, floor + 2 * slack)))

      found.push_back({one, other});
  });
  std::sort(found.begin(), found.end());
}

}  // namespace vibe
