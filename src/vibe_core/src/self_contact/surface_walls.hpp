#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

#include "vibe_core/geometry/surface_mesh.hpp"

namespace vibe {

/// Says which vertices of a surface are so near along it that they belong to the same wall.
class SurfaceWalls {
 public:
  /// @param reach  distance along edges within which the surface is one wall; vertices within two edges always are [m]
  SurfaceWalls(const SurfaceMesh& rest, double reach);

  bool oneWall(int vertex, int other) const {
    return std::binary_search(wall_.begin() + start_[vertex], wall_.begin() + start_[vertex + 1], other);
  }

 private:
  std::vector<int> start_, wall_;  // vertices of the same wall, ascending
};

/// The triangles at each vertex of a surface.
class VertexTriangles {
 public:
  VertexTriangles(const std::vector<std::array<int, 3>>& triangles, std::size_t vertices)
      : start_(vertices + 1, 0), triangle_(3 * triangles.size()) {
    for (const auto& t : triangles)
      for (const int v : t) ++start_[v + 1];
    for (std::size_t i = 0; i < vertices; ++i) start_[i + 1] += start_[i];
    std::vector<int> next(start_.begin(), start_.end() - 1);
    for (std::size_t t = 0; t < triangles.size(); ++t)
      for (const int v : triangles[t]) triangle_[next[v]++] = static_cast<int>(t);
  }

  std::size_t vertexCount() const { return start_.size() - 1; }
  /// The first one at a vertex, which must have some.
  int first(int vertex) const { return triangle_[start_[vertex]]; }
  /// Calls visit(triangle) for each triangle at a vertex, ascending.
  template <typename Visit>
  void visit(int vertex, Visit visit) const {
    for (int i = start_[vertex]; i < start_[vertex + 1]; ++i) visit(triangle_[i]);
  }

 private:
  std::vector<int> start_, triangle_;
};

}  // namespace vibe
