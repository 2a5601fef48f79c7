#include "geometry/surface_graph.hpp"

#include <Eigen/SparseCore>
#include <algorithm>
#include <limits>
#include <queue>
#include <utility>

namespace vibe::graphics {
namespace {

/// Both directions of every edge, each once, in ascending order.
std::vector<std::pair<std::uint32_t, std::uint32_t>> edgesOf(const std::vector<std::uint32_t>& triangles) {
  std::vector<std::pair<std::uint32_t, std::uint32_t>> edges;
  for (std::size_t t = 0; t + 2 < triangles.size(); t += 3)
    for (std::size_t c = 0; c < 3; ++c) {
      const std::uint32_t a = triangles[t + c], b = triangles[t + (c + 1) % 3];
      edges.emplace_back(a, b), edges.emplace_back(b, a);
    }
  std::sort(edges.begin(), edges.end());
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
  return edges;
}

}  // namespace

SurfaceGraph::SurfaceGraph(const std::vector<std::uint32_t>& triangles, const std::vector<float>& places) {
  const Eigen::Map<const Eigen::Matrix3Xf> place(places.data(), 3, static_cast<Eigen::Index>(places.size() / 3));
  first_.assign(places.size() / 3 + 1, 0);
  for (const auto& [from, to] : edgesOf(triangles)) {
    ++first_[from + 1];
    neighbours_.push_back(to);
    length_.push_back(static_cast<double>((place.col(from) - place.col(to)).norm()));
    mean_edge_ += length_.back();
  }
  for (std::size_t v = 1; v < first_.size(); ++v) first_[v] += first_[v - 1];
  if (!length_.empty()) mean_edge_ /= static_cast<double>(length_.size());
}

std::vector<double> SurfaceGraph::distanceTo(const std::vector<std::uint32_t>& vertices) const {
  using Way = std::pair<double, std::uint32_t>;
  std::vector<double> distance(vertexCount(), std::numeric_limits<double>::infinity());
  std::priority_queue<Way, std::vector<Way>, std::greater<>> ways;
  for (const std::uint32_t v : vertices) distance[v] = 0, ways.emplace(0, v);
  while (!ways.empty()) {
    const auto [way, v] = ways.top();
    ways.pop();
    if (way > distance[v]) continue;
    for (std::uint32_t k = first_[v]; k < first_[v + 1]; ++k) {
      const double longer = way + length_[k];
      if (longer >= distance[neighbours_[k]]) continue;
      distance[neighbours_[k]] = longer;
      ways.emplace(longer, neighbours_[k]);
    }
  }
  return distance;
}

Eigen::MatrixXd SurfaceGraph::blurred(const Eigen::MatrixXd& values, double radius) const {
  if (!(mean_edge_ > 0)) return values;
  // sum over the six neighbours of (u_j - u_i) = 3/2 h^2 Laplace u on a lattice of equilateral triangles with edge h
  const double weight = radius * radius / (1.5 * mean_edge_ * mean_edge_);
  std::vector<Eigen::Triplet<double>> entries;
  for (std::size_t v = 0; v < vertexCount(); ++v) {
    const auto row = static_cast<int>(v);
    entries.emplace_back(row, row, 1 + weight * (first_[v + 1] - first_[v]));
    for (std::uint32_t k = first_[v]; k < first_[v + 1]; ++k)
      entries.emplace_back(row, static_cast<int>(neighbours_[k]), -weight);
  }
  const auto count = static_cast<Eigen::Index>(vertexCount());
  Eigen::SparseMatrix<double> matrix(count, count);
  matrix.setFromTriplets(entries.begin(), entries.end());
  const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factor(matrix);  // positive definite by construction
  return factor.solve(values);
}

}  // namespace vibe::graphics
