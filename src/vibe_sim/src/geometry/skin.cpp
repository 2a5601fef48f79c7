#include "vibe_sim/geometry/skin.hpp"

#include <cmath>
#include <map>
#include <utility>

#include "vibe_sim/error.hpp"

namespace vibe {

namespace {

using Edge = std::pair<int, int>;

Edge makeEdge(int a, int b) {
  return a < b ? Edge(a, b) : Edge(b, a);
}

/// What Loop's rule for a new vertex needs: its number, and the vertices opposite to the edge.
struct EdgeVertex {
  int number = 0;
  std::array<int, 2> opposite{-1, -1};
};

std::map<Edge, EdgeVertex> findEdges(const SurfaceMesh& mesh) {
  std::map<Edge, EdgeVertex> edges;
  for (const auto& t : mesh.triangles) {
    for (int k = 0; k < 3; ++k) {
      EdgeVertex& e = edges[makeEdge(t[k], t[(k + 1) % 3])];
      const int opposite = t[(k + 2) % 3];
      if (e.opposite[0] < 0) {
        e.opposite[0] = opposite;
      } else if (e.opposite[1] < 0) {
        e.opposite[1] = opposite;
      } else {
        throw Error("makeLoopSkin: an edge at vertex " + std::to_string(t[k]) +
                    " has more than two triangles; check the surface with checkSurface() first");
      }
    }
  }
  int next = static_cast<int>(mesh.vertices.size());
  for (auto& [edge, e] : edges) {
    if (e.opposite[1] < 0) {
      throw Error("makeLoopSkin: the surface is open at the edge from vertex " + std::to_string(edge.first) + " to " +
                  std::to_string(edge.second) + "; close it first");
    }
    e.number = next++;
  }
  return edges;
}

void addWeight(Skin& skin, int particle, double weight) {
  skin.particles.push_back(particle);
  skin.weights.push_back(static_cast<float>(weight));
}

/// Loop's rule for an old vertex of valence n, beta as in Loop's thesis (1987).
void addOldVertex(Skin& skin, int vertex, const std::vector<int>& neighbours) {
  const double n = static_cast<double>(neighbours.size());
  if (neighbours.empty()) {
    addWeight(skin, vertex, 1.0);
  } else {
    const double c = 3.0 / 8.0 + std::cos(2.0 * M_PI / n) / 4.0;
    const double beta = (5.0 / 8.0 - c * c) / n;
    addWeight(skin, vertex, 1.0 - n * beta);
    for (const int k : neighbours) addWeight(skin, k, beta);
  }
  skin.offsets.push_back(static_cast<int>(skin.particles.size()));
}

void addNewVertex(Skin& skin, const Edge& edge, const EdgeVertex& e) {
  addWeight(skin, edge.first, 3.0 / 8.0);
  addWeight(skin, edge.second, 3.0 / 8.0);
  addWeight(skin, e.opposite[0], 1.0 / 8.0);
  addWeight(skin, e.opposite[1], 1.0 / 8.0);
  skin.offsets.push_back(static_cast<int>(skin.particles.size()));
}

}  // namespace

Skin makeLoopSkin(const SurfaceMesh& particles) {
  const std::map<Edge, EdgeVertex> edges = findEdges(particles);
  const auto neighbours = vertexNeighbours(particles);
  Skin skin;
  skin.offsets.push_back(0);
  for (int v = 0; v < static_cast<int>(particles.vertices.size()); ++v) addOldVertex(skin, v, neighbours[v]);
  for (const auto& [edge, e] : edges) addNewVertex(skin, edge, e);  // in the order of their numbers
  for (const auto& t : particles.triangles) {
    const int ab = edges.at(makeEdge(t[0], t[1])).number;
    const int bc = edges.at(makeEdge(t[1], t[2])).number;
    const int ca = edges.at(makeEdge(t[2], t[0])).number;
    skin.triangles.push_back({t[0], ab, ca});
    skin.triangles.push_back({t[1], bc, ab});
    skin.triangles.push_back({t[2], ca, bc});
    skin.triangles.push_back({ab, bc, ca});
  }
  return skin;
}

std::vector<Eigen::Vector3d> skinPositions(const Skin& skin, const std::vector<Eigen::Vector3d>& particles) {
  const int count = skin.offsets.empty() ? 0 : static_cast<int>(skin.offsets.size()) - 1;
  std::vector<Eigen::Vector3d> positions(count, Eigen::Vector3d::Zero());
  for (int v = 0; v < count; ++v) {
    for (int k = skin.offsets[v]; k < skin.offsets[v + 1]; ++k) {
      positions[v] += static_cast<double>(skin.weights[k]) * particles[skin.particles[k]];
    }
  }
  return positions;
}

}  // namespace vibe
