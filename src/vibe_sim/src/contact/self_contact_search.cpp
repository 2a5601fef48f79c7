#include "self_contact_search.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <queue>
#include <utility>

namespace vibe {

namespace {

/// Least product of two vectors from the boxes.
float leastDot(const Eigen::Vector3f& low, const Eigen::Vector3f& high, const Eigen::Vector3f& other_low,
               const Eigen::Vector3f& other_high) {
  return (low.cwiseProduct(other_low))
      .cwiseMin(low.cwiseProduct(other_high))
      .cwiseMin(high.cwiseProduct(other_low))
      .cwiseMin(high.cwiseProduct(other_high))
      .sum();
}

}  // namespace

SelfContactSearch::SelfContactSearch(const SurfaceMesh& rest, const std::vector<double>& one_wall)
    : triangles_(rest.triangles), position_(rest.vertices), area_vector_(rest.triangles.size()) {
  const std::size_t n = rest.vertices.size();
  triangle_start_.assign(n + 1, 0);
  for (const auto& t : triangles_)
    for (const int v : t) ++triangle_start_[v + 1];
  for (std::size_t i = 0; i < n; ++i) triangle_start_[i + 1] += triangle_start_[i];
  triangle_of_.resize(3 * triangles_.size());
  std::vector<int> next(triangle_start_.begin(), triangle_start_.end() - 1);
  for (std::size_t t = 0; t < triangles_.size(); ++t)
    for (const int v : triangles_[t]) triangle_of_[next[v]++] = static_cast<int>(t);
  normal_.resize(n);
  near_.resize(n);
  cell_of_.resize(n);
  sorted_.resize(n);
  flagged_.assign(n, 0);
  vertex_stamp_.assign(n, 0);
  triangle_stamp_.assign(triangles_.size(), 0);
  joinWalls(rest, one_wall);
}

// Dijkstra from every vertex, as far as its wall goes: two edges at least.
void SelfContactSearch::joinWalls(const SurfaceMesh& rest, const std::vector<double>& one_wall) {
  const auto neighbours = vertexNeighbours(rest);
  const int n = static_cast<int>(rest.vertices.size());
  std::vector<double> length(n, std::numeric_limits<double>::infinity());
  std::vector<int> edges(n, 3), touched;
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

void SelfContactSearch::place(const std::vector<Eigen::Vector3d>& positions) {
  position_ = positions;
  std::fill(normal_.begin(), normal_.end(), Eigen::Vector3d::Zero());
  std::fill(near_.begin(), near_.end(), 0);
  double longest = 0, lowest = std::numeric_limits<double>::max();  // squares
  for (std::size_t t = 0; t < triangles_.size(); ++t) {
    const auto& n = triangles_[t];
    const Eigen::Vector3d ab = position_[n[1]] - position_[n[0]], ac = position_[n[2]] - position_[n[0]];
    const Eigen::Vector3d area = ab.cross(ac);
    const double edge = std::max({ab.squaredNorm(), ac.squaredNorm(), (ac - ab).squaredNorm()});
    longest = std::max(longest, edge);
    if (area.squaredNorm() < lowest * edge) lowest = area.squaredNorm() / edge;
    area_vector_[t] = area;
    for (const int v : n) {
      normal_[v] += area;
      near_[v] = std::max(near_[v], edge);  // squared until flagNear
    }
  }
  for (Eigen::Vector3d& normal : normal_) {
    const double length = normal.norm();
    if (length > 0) normal *= 1 / length;
  }
  longest_edge_ = std::sqrt(longest);
  lowest_height_ = std::sqrt(lowest);
}

void SelfContactSearch::flagNear(double distance) {
  // no point of a triangle is farther from its nearest vertex than this part of its longest edge
  for (double& near : near_) near = distance + std::sqrt(near / 3);
  layGrid(distance + longest_edge_ / std::sqrt(3.0));
  fillCells();
  std::fill(flagged_.begin(), flagged_.end(), char{0});
  any_flagged_ = false;
  for (const Cell& cell : filled_) {
    for (int side = 13; side < 27; ++side) {  // itself, and one of each pair of opposite neighbours
      const int x = cell.at[0] + side % 3 - 1, y = cell.at[1] + side / 3 % 3 - 1, z = cell.at[2] + side / 9 - 1;
      if (x < 0 || y < 0 || x >= cells_[0] || y >= cells_[1] || z >= cells_[2]) continue;
      const int other = occupied_[(z * cells_[1] + y) * cells_[0] + x];
      if (other >= 0) comparePair(cell, filled_[other]);
    }
  }
}

void SelfContactSearch::layGrid(double distance) {
  Eigen::Vector3d low = position_[0], high = position_[0];
  for (const Eigen::Vector3d& p : position_) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  corner_ = low;
  const Eigen::Vector3d size = high - low;
  const double most = 4.0 * static_cast<double>(position_.size()) + 64;
  for (cell_ = distance;; cell_ *= 1.25) {
    const Eigen::Vector3d count = (size / cell_).array().floor() + 1;
    if (!(count.prod() <= most)) continue;
    for (int k = 0; k < 3; ++k) cells_[k] = static_cast<int>(count[k]);
    return;
  }
}

int SelfContactSearch::cellNumber(const Eigen::Vector3d& p, std::array<int, 3>& at) const {
  for (int k = 0; k < 3; ++k) at[k] = std::min(static_cast<int>((p[k] - corner_[k]) / cell_), cells_[k] - 1);
  return (at[2] * cells_[1] + at[1]) * cells_[0] + at[0];
}

// Counting sort: vertices stay in ascending order within a cell.
void SelfContactSearch::fillCells() {
  const int count = cells_[0] * cells_[1] * cells_[2];
  cell_start_.assign(static_cast<std::size_t>(count) + 1, 0);
  std::array<int, 3> at;
  for (std::size_t i = 0; i < position_.size(); ++i) ++cell_start_[(cell_of_[i] = cellNumber(position_[i], at)) + 1];
  for (int c = 0; c < count; ++c) cell_start_[c + 1] += cell_start_[c];
  occupied_.assign(cell_start_.begin(), cell_start_.end() - 1);
  for (std::size_t i = 0; i < position_.size(); ++i) sorted_[occupied_[cell_of_[i]]++] = static_cast<int>(i);
  filled_.clear();
  for (int c = 0; c < count; ++c) {
    occupied_[c] = -1;
    if (cell_start_[c] == cell_start_[c + 1]) continue;
    occupied_[c] = static_cast<int>(filled_.size());
    Cell cell{{c % cells_[0], c / cells_[0] % cells_[1], c / cells_[0] / cells_[1]},
              cell_start_[c],
              cell_start_[c + 1],
              Eigen::Vector3f::Constant(2),
              Eigen::Vector3f::Constant(-2)};
    for (int k = cell.first; k < cell.last; ++k) {
      const Eigen::Vector3f normal = normal_[sorted_[k]].cast<float>();
      cell.low = cell.low.cwiseMin(normal);
      cell.high = cell.high.cwiseMax(normal);
    }
    filled_.push_back(cell);
  }
}

void SelfContactSearch::comparePair(const Cell& one, const Cell& other) {
  if (leastDot(one.low, one.high, other.low, other.high) > static_cast<float>(kWatchedCosine)) return;
  for (int k = one.first; k < one.last; ++k) {
    const int i = sorted_[k];
    for (int l = one.first == other.first ? k + 1 : other.first; l < other.last; ++l) {
      const int j = sorted_[l];
      const double near = std::max(near_[i], near_[j]);
      if ((flagged_[i] != 0 && flagged_[j] != 0) || (position_[i] - position_[j]).squaredNorm() > near * near ||
          normal_[i].dot(normal_[j]) > kWatchedCosine || oneWall(i, j))
        continue;
      flagged_[i] = flagged_[j] = 1;
      any_flagged_ = true;
    }
  }
}

}  // namespace vibe
