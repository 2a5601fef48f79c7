#include <algorithm>
#include <cstdint>
#include <string>
#include <unordered_map>

#include "tetrahedra/tetrahedra.hpp"
#include "vibe_core/common/error.hpp"

namespace vibe::benchmarks {

QuadraticMesh quadraticMesh(const TetMesh<4>& linear) {
  constexpr int kEdges[6][2] = {{0, 1}, {1, 2}, {2, 0}, {0, 3}, {1, 3}, {2, 3}};
  QuadraticMesh out;
  out.mesh.nodes = linear.nodes;
  out.mesh.materials = linear.materials;
  out.mesh.material = linear.material;
  std::unordered_map<std::uint64_t, int> number_of;
  const auto midNode = [&](int a, int b) {
    const auto [low, high] = std::minmax(a, b);
    const std::uint64_t key = static_cast<std::uint64_t>(low) << 32 | static_cast<std::uint32_t>(high);
    const auto [entry, is_new] = number_of.try_emplace(key, static_cast<int>(out.mesh.nodes.size()));
    if (is_new) {
      const auto position = [&](int v) { return linear.nodes[static_cast<std::size_t>(v)]; };
      out.mesh.nodes.push_back((position(low) + position(high)) / 2);
      out.edges.push_back({low, high});
    }
    return entry->second;
  };
  for (std::size_t e = 0; e < linear.elements.size(); ++e) {
    const auto& vertices = linear.elements[e];
    for (const int v : vertices)
      if (v < 0 || static_cast<std::size_t>(v) >= linear.nodes.size())
        throw Error("tetrahedron " + std::to_string(e) + " (counted from 0) has node " + std::to_string(v) +
                    ", but the mesh has " + std::to_string(linear.nodes.size()) +
                    " nodes: correct the element or add the node.");
    std::array<int, 10> nodes;
    std::copy(vertices.begin(), vertices.end(), nodes.begin());
    for (std::size_t k = 0; k < 6; ++k)
      nodes[4 + k] =
          midNode(vertices[static_cast<std::size_t>(kEdges[k][0])], vertices[static_cast<std::size_t>(kEdges[k][1])]);
    out.mesh.elements.push_back(nodes);
  }
  return out;
}

}  // namespace vibe::benchmarks
