#include "fem/mesh_refine.hpp"

#include <algorithm>

namespace vibe::benchmarks {

void growSets(const std::vector<std::array<int, 2>>& middles, int before, BenchMesh& mesh) {
  for (auto& set : mesh.sets) {
    std::vector<char> inside(before, 0);
    for (const int node : set.second) inside[node] = 1;
    for (std::size_t m = 0; m < middles.size(); ++m)
      if (inside[middles[m][0]] != 0 && inside[middles[m][1]] != 0) set.second.push_back(before + static_cast<int>(m));
  }
}

BenchMesh refineTriangles(const BenchMesh& mesh, const Eigen::Vector3d& project) {
  BenchMesh fine = mesh;
  fine.triangles.clear();
  std::map<std::array<int, 2>, int> middle_of;
  std::vector<std::array<int, 2>> middles;
  const auto middle = [&](int a, int b) {
    const std::array<int, 2> side{std::min(a, b), std::max(a, b)};
    const auto [entry, is_new] = middle_of.emplace(side, static_cast<int>(fine.nodes.size()));
    if (is_new) {
      Eigen::Vector3d node = 0.5 * (mesh.nodes[a] + mesh.nodes[b]);
      if (project.norm() > 0) node /= node.cwiseQuotient(project).norm();
      fine.nodes.push_back(node);
      middles.push_back(side);
    }
    return entry->second;
  };
  for (const auto& t : mesh.triangles) {
    const int ab = middle(t[0], t[1]), bc = middle(t[1], t[2]), ca = middle(t[2], t[0]);
    fine.triangles.insert(fine.triangles.end(), {{t[0], ab, ca}, {ab, t[1], bc}, {ca, bc, t[2]}, {ab, bc, ca}});
  }
  growSets(middles, static_cast<int>(mesh.nodes.size()), fine);
  return fine;
}

}  // namespace vibe::benchmarks
