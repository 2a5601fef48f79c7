#include "vibe_graphics/geometry/mesh_index.hpp"

#include <algorithm>
#include <numeric>

#include <Eigen/Geometry>

namespace vibe::graphics {

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

namespace {

constexpr int kBits = 10;  // of a coordinate

/// Bits of three coordinates from 0 to 1 by turns.
std::uint32_t mortonCode(const Eigen::Vector3f& unit) {
  std::uint32_t code = 0;
  for (int c = 0; c < 3; ++c) {
    const auto cell = static_cast<std::uint32_t>(std::clamp(unit[c], 0.0F, 1.0F) * ((1 << kBits) - 1));
    for (int bit = 0; bit < kBits; ++bit) code |= ((cell >> bit) & 1U) << (3 * bit + c);
  }
  return code;
}

}  // namespace

std::vector<std::uint32_t> sortedInSpace(const std::vector<std::uint32_t>& triangles,
                                         const std::vector<float>& places) {
  if (places.empty()) return triangles;
  const Eigen::Map<const Eigen::Matrix3Xf> place(places.data(), 3, static_cast<Eigen::Index>(places.size() / 3));
  const Eigen::Vector3f lowest = place.rowwise().minCoeff();
  const float edge = std::max((place.rowwise().maxCoeff() - lowest).maxCoeff(), 1e-9F);
  std::vector<std::uint32_t> codes, order(triangles.size() / 3), sorted;
  for (std::size_t t = 0; t < triangles.size(); t += 3) {
    const Eigen::Vector3f middle =
        (place.col(triangles[t]) + place.col(triangles[t + 1]) + place.col(triangles[t + 2])) / 3;
    codes.push_back(mortonCode((middle - lowest) / edge));
  }
  std::iota(order.begin(), order.end(), 0U);
  std::stable_sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) { return codes[a] < codes[b]; });
  for (const std::uint32_t t : order) sorted.insert(sorted.end(), &triangles[3 * t], &triangles[3 * t] + 3);
  return sorted;
}

}  // namespace vibe::graphics
