#include "contact/self_contact_search.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <queue>
#include <utility>

#include "contact/self_contact_distance.hpp"

namespace vibe {

SelfContactSearch::SelfContactSearch(const SurfaceMesh& rest, const std::vector<double>& one_wall)
    : triangles_(rest.triangles) {
  const std::size_t n = rest.vertices.size();
  triangle_start_.assign(n + 1, 0);
  for (const auto& t : triangles_)
    for (const int v : t) ++triangle_start_[v + 1];
  for (std::size_t i = 0; i < n; ++i) triangle_start_[i + 1] += triangle_start_[i];
  triangle_of_.resize(3 * triangles_.size());
  std::vector<int> next(triangle_start_.begin(), triangle_start_.end() - 1);
  for (std::size_t t = 0; t < triangles_.size(); ++t)
    for (const int v : triangles_[t]) triangle_of_[next[v]++] = static_cast<int>(t);
  edge_.resize(n);
  cell_of_.resize(n);
  sorted_.resize(n);
  wall_stamp_.assign(n, 0);
  triangle_stamp_.assign(triangles_.size(), 0);
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

bool SelfContactSearch::sameWall(const std::array<int, 3>& one, const std::array<int, 3>& other) const {
  for (const int v : one)
    for (const int w : other)
      if (oneWall(v, w)) return true;
  return false;
}

void SelfContactSearch::findNear(const std::vector<Eigen::Vector3d>& positions, double distance,
                                 std::vector<Near>& found) {
  found.clear();
  measureEdges(positions);
  // a point of a triangle is never farther from its nearest vertex than this fraction of its longest edge
  layGrid(positions, distance + longest_edge_ * (0.5 + 1 / std::sqrt(3.0)));
  fillCells(positions);
  for (int i = 0; i < static_cast<int>(positions.size()); ++i)
    findNearOf(i, positions, distance + 0.5 * edge_[i], found);
}

void SelfContactSearch::measureEdges(const std::vector<Eigen::Vector3d>& positions) {
  std::fill(edge_.begin(), edge_.end(), 0.0);
  double longest = 0;
  for (const auto& n : triangles_) {
    const double edge =
        std::max({(positions[n[0]] - positions[n[1]]).squaredNorm(), (positions[n[1]] - positions[n[2]]).squaredNorm(),
                  (positions[n[2]] - positions[n[0]]).squaredNorm()});
    for (const int v : n) edge_[v] = std::max(edge_[v], edge);
    longest = std::max(longest, edge);
  }
  for (double& edge : edge_) edge = std::sqrt(edge);
  longest_edge_ = std::sqrt(longest);
}

void SelfContactSearch::layGrid(const std::vector<Eigen::Vector3d>& positions, double distance) {
  Eigen::Vector3d low = positions[0], high = positions[0];
  for (const Eigen::Vector3d& p : positions) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  corner_ = low;
  const Eigen::Vector3d size = high - low;
  const double max = 4.0 * static_cast<double>(positions.size()) + 64;
  for (cell_ = distance;; cell_ *= 1.25) {
    const Eigen::Vector3d count = (size / cell_).array().floor() + 1;
    if (!(count.prod() <= max)) continue;
    for (int k = 0; k < 3; ++k) cells_[k] = static_cast<int>(count[k]);
    return;
  }
}

std::array<int, 3> SelfContactSearch::cellOf(const Eigen::Vector3d& p) const {
  std::array<int, 3> at;
  for (int k = 0; k < 3; ++k) at[k] = std::min(static_cast<int>((p[k] - corner_[k]) / cell_), cells_[k] - 1);
  return at;
}

// Counting sort: vertices stay in ascending order within a cell.
void SelfContactSearch::fillCells(const std::vector<Eigen::Vector3d>& positions) {
  cell_start_.assign(static_cast<std::size_t>(cells_[0] * cells_[1] * cells_[2]) + 1, 0);
  for (std::size_t i = 0; i < positions.size(); ++i) {
    const std::array<int, 3> at = cellOf(positions[i]);
    cell_of_[i] = (at[2] * cells_[1] + at[1]) * cells_[0] + at[0];
    ++cell_start_[cell_of_[i] + 1];
  }
  for (std::size_t c = 0; c + 1 < cell_start_.size(); ++c) cell_start_[c + 1] += cell_start_[c];
  next_.assign(cell_start_.begin(), cell_start_.end() - 1);
  for (std::size_t i = 0; i < positions.size(); ++i) sorted_[next_[cell_of_[i]]++] = static_cast<int>(i);
}

void SelfContactSearch::findNearOf(int vertex, const std::vector<Eigen::Vector3d>& positions, double distance,
                                   std::vector<Near>& found) {
  ++stamp_;
  for (int k = wall_start_[vertex]; k < wall_start_[vertex + 1]; ++k) wall_stamp_[wall_[k]] = stamp_;
  candidates_.clear();
  const std::array<int, 3> at = cellOf(positions[vertex]);
  for (int z = std::max(at[2] - 1, 0); z <= std::min(at[2] + 1, cells_[2] - 1); ++z)
    for (int y = std::max(at[1] - 1, 0); y <= std::min(at[1] + 1, cells_[1] - 1); ++y)
      for (int x = std::max(at[0] - 1, 0); x <= std::min(at[0] + 1, cells_[0] - 1); ++x)
        visitCell((z * cells_[1] + y) * cells_[0] + x, vertex, positions, distance);
  std::sort(candidates_.begin(), candidates_.end());
  for (const int t : candidates_) {
    const auto& n = triangles_[t];
    const TriangleFoot foot = triangleFoot(positions[vertex], positions[n[0]], positions[n[1]], positions[n[2]]);
    if (foot.away.squaredNorm() < distance * distance) found.push_back({vertex, t});
  }
}

void SelfContactSearch::visitCell(int cell, int vertex, const std::vector<Eigen::Vector3d>& positions,
                                  double distance) {
  for (int k = cell_start_[cell]; k < cell_start_[cell + 1]; ++k) {
    const int other = sorted_[k];
    const double near = distance + edge_[other] / std::sqrt(3.0);
    if (wall_stamp_[other] == stamp_ || (positions[other] - positions[vertex]).squaredNorm() > near * near) continue;
    visitRing(other, [&](int t) {
      if (triangle_stamp_[t] == stamp_) return;
      triangle_stamp_[t] = stamp_;
      const auto& n = triangles_[t];
      if (wall_stamp_[n[0]] != stamp_ && wall_stamp_[n[1]] != stamp_ && wall_stamp_[n[2]] != stamp_)
        candidates_.push_back(t);
    });
  }
}

}  // namespace vibe
