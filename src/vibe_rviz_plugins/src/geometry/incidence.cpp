#include "geometry/incidence.hpp"

namespace vibe::rviz_plugins {
namespace {

void makeRoom(const std::vector<std::uint32_t>& groups_of_item, std::size_t groups, Incidence& result) {
  result.first.assign(groups + 1, 0);
  for (const std::uint32_t group : groups_of_item) ++result.first[group + 1];
  for (std::size_t g = 0; g < groups; ++g) result.first[g + 1] += result.first[g];
  result.items.resize(groups_of_item.size());
}

}  // namespace

Incidence turnedAround(const std::vector<std::uint32_t>& offset, const std::vector<std::uint32_t>& groups_of_item,
                       std::size_t groups) {
  Incidence result;
  makeRoom(groups_of_item, groups, result);
  std::vector<std::uint32_t> next(result.first.begin(), result.first.end() - 1);
  for (std::uint32_t item = 0; item + 1 < offset.size(); ++item)
    for (std::uint32_t k = offset[item]; k < offset[item + 1]; ++k) result.items[next[groups_of_item[k]]++] = item;
  return result;
}

Incidence turnedAround(const std::vector<std::uint32_t>& groups_of_item, std::size_t each, std::size_t groups) {
  std::vector<std::uint32_t> offset(groups_of_item.size() / each + 1);
  for (std::size_t i = 0; i < offset.size(); ++i) offset[i] = static_cast<std::uint32_t>(i * each);
  return turnedAround(offset, groups_of_item, groups);
}

}  // namespace vibe::rviz_plugins
