#pragma once
#include <cstdint>
#include <vector>

namespace vibe::rviz_plugins {

/// The items of each group, group by group: items[first[g]] to items[first[g + 1]].
struct Incidence {
  std::vector<std::uint32_t> first, items;

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

}  // namespace vibe::rviz_plugins
