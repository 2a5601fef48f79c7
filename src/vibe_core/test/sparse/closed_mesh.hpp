#pragma once

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <map>
#include <memory>
#include <set>
#include <vector>

#include "vibe_core/sparse/block_matrix.hpp"

namespace vibe::test {

/// A unit sphere of triangles: every face of an icosahedron cut into `cuts` squared triangles, 10 cuts^2 + 2 nodes.
struct ClosedMesh {
  std::vector<Eigen::Vector3d> nodes;
  std::vector<std::array<int, 3>> triangles;
};

inline ClosedMesh closedMesh(int cuts) {
  const double g = (1 + std::sqrt(5.0)) / 2;
  const std::vector<Eigen::Vector3d> corner = {{-1, g, 0}, {1, g, 0}, {-1, -g, 0}, {1, -g, 0},
                                               {0, -1, g}, {0, 1, g}, {0, -1, -g}, {0, 1, -g},
                                               {g, 0, -1}, {g, 0, 1}, {-g, 0, -1}, {-g, 0, 1}};
  const int faces[20][3] = {{0, 11, 5},  {0, 5, 1},  {0, 1, 7},  {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
                            {11, 10, 2}, {10, 7, 6}, {7, 1, 8},  {3, 9, 4},  {3, 4, 2},   {3, 2, 6}, {3, 6, 8},
                            {3, 8, 9},   {4, 9, 5},  {2, 4, 11}, {6, 2, 10}, {8, 6, 7},   {9, 8, 1}};
  ClosedMesh mesh;
  std::map<std::array<long, 3>, int> known;
  const auto node = [&](const Eigen::Vector3d& p) {
    const std::array<long, 3> key = {std::lround(p.x() * 1e7), std::lround(p.y() * 1e7), std::lround(p.z() * 1e7)};
    const auto [it, added] = known.emplace(key, static_cast<int>(mesh.nodes.size()));
    if (added) mesh.nodes.push_back(p.normalized());
    return it->second;
  };
  for (const auto& face : faces) {
    const auto at = [&](int i, int j) {
      return node((corner[face[0]] * (cuts - i - j) + corner[face[1]] * i + corner[face[2]] * j) / cuts);
    };
    for (int i = 0; i < cuts; ++i)
      for (int j = 0; i + j < cuts; ++j) {
        mesh.triangles.push_back({at(i, j), at(i + 1, j), at(i, j + 1)});
        if (i + j + 1 < cuts) mesh.triangles.push_back({at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)});
      }
  }
  return mesh;
}

inline std::vector<std::set<int>> ringOf(const ClosedMesh& mesh) {
  std::vector<std::set<int>> ring(mesh.nodes.size());
  for (const auto& t : mesh.triangles)
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        if (i != j) ring[t[i]].insert(t[j]);
  return ring;
}

/// Every node couples with the nodes at most two edges away, as in a shell that bends.
inline BlockPattern shellPattern(const ClosedMesh& mesh) {
  const std::vector<std::set<int>> ring = ringOf(mesh);
  std::vector<int> pairs;
  for (int i = 0; i < static_cast<int>(ring.size()); ++i)
    for (const int j : ring[i]) {
      pairs.insert(pairs.end(), {i, j});
      for (const int k : ring[j])
        if (k != i) pairs.insert(pairs.end(), {i, k});
    }
  return blockPattern(static_cast<int>(ring.size()), {{&pairs, 2}});
}

/// Stretch springs along the edges, bending by the square of the umbrella operator, and a little mass.
inline BlockMatrix shellMatrix(const ClosedMesh& mesh, double bending, double mass) {
  BlockMatrix matrix(std::make_shared<BlockPattern>(shellPattern(mesh)));
  const std::vector<std::set<int>> ring = ringOf(mesh);
  const Eigen::Matrix3d unit = Eigen::Matrix3d::Identity();
  for (int i = 0; i < static_cast<int>(ring.size()); ++i) {
    matrix.add(i, i, mass * unit);
    std::vector<std::pair<int, double>> umbrella = {{i, 1.0}};
    for (const int j : ring[i]) {
      umbrella.emplace_back(j, -1.0 / static_cast<double>(ring[i].size()));
      if (j < i) continue;
      const Eigen::Vector3d along = (mesh.nodes[j] - mesh.nodes[i]).normalized();
      const Eigen::Matrix3d stiffness = along * along.transpose();
      matrix.add(i, i, stiffness);
      matrix.add(j, j, stiffness);
      matrix.add(j, i, -stiffness);
    }
    for (const auto& [a, wa] : umbrella)
      for (const auto& [b, wb] : umbrella)
        if (b <= a) matrix.add(a, b, bending * wa * wb * unit);
  }
  return matrix;
}

}  // namespace vibe::test
