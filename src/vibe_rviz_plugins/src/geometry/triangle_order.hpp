#pragma once
#include <cstdint>
#include <vector>

namespace vibe::rviz_plugins {

/// The same triangles, sorted so that neighbours in the list are neighbours in space (order of Morton 1966): a renderer
/// then finds most corners among those that it has computed a moment ago.
/// @param triangles  three vertices each
/// @param places     x y z per vertex; any unit
std::vector<std::uint32_t> sortedInSpace(const std::vector<std::uint32_t>& triangles, const std::vector<float>& places);

}  // namespace vibe::rviz_plugins
