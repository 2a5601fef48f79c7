#pragma once
#include <algorithm>
#include <cstddef>

namespace vibe::rviz_plugins {

/// Vertices from `first` up to but excluding `last`: the part of a buffer that must be sent again.
struct VertexSpan {
  std::size_t first = 0, last = 0;

  bool empty() const { return first >= last; }
  std::size_t count() const { return empty() ? 0 : last - first; }
  void add(std::size_t vertex) {
    if (empty()) first = vertex, last = vertex + 1;
    first = std::min(first, vertex);
    last = std::max(last, vertex + 1);
  }
};

}  // namespace vibe::rviz_plugins
