#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace vibe::graphics {

/// Vertices from `first` up to but excluding `last`: the part of a buffer that must be sent again.
struct VertexSpan {
  std::size_t first = 0, last = 0;  ///< vertex numbers; equal: none

  bool empty() const { return first >= last; }
  std::size_t count() const { return empty() ? 0 : last - first; }  ///< vertices of the span
  /// Widens the span so that it has this vertex, and all between.
  void add(std::size_t vertex) {
    if (empty()) first = vertex, last = vertex + 1;
    first = std::min(first, vertex);
    last = std::max(last, vertex + 1);
  }
};

/// The items of each group, group by group: items[first[g]] to items[first[g + 1]].
struct Incidence {
  std::vector<std::uint32_t> first, items;  ///< one more than there are groups; the items of all groups

  const std::uint32_t* begin(std::size_t group) const { return items.data() + first[group]; }
  const std::uint32_t* end(std::size_t group) const { return items.data() + first[group + 1]; }
};

/// Inverts lists of groups per item: item i is in the groups groups_of_item[k], k from offset[i] to
/// offset[i + 1]. Items are in ascending order in each group.
/// @param groups  their number; all entries of groups_of_item are below it
Incidence turnedAround(const std::vector<std::uint32_t>& offset, const std::vector<std::uint32_t>& groups_of_item,
                       std::size_t groups);
/// The same for items that are in `each` groups, such as triangles with three corners.
Incidence turnedAround(const std::vector<std::uint32_t>& groups_of_item, std::size_t each, std::size_t groups);

/// The same triangles, sorted so that neighbours in the list are neighbours in space (order of Morton 1966): a renderer
/// then finds most corners among those that it has computed a moment ago.
/// @param triangles  three vertices each
/// @param places     x y z per vertex; any unit
std::vector<std::uint32_t> sortedInSpace(const std::vector<std::uint32_t>& triangles, const std::vector<float>& places);

}  // namespace vibe::graphics
