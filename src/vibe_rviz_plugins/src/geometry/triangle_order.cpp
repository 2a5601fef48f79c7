#include "geometry/triangle_order.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <numeric>

namespace vibe::rviz_plugins {
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

}  // namespace vibe::rviz_plugins
