#pragma once

#include <array>
#include <cstddef>
#include <vector>

namespace vibe {

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
