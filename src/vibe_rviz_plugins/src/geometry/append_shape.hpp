#pragma once
#include "vibe_rviz_plugins/geometry/coloured_shape.hpp"

namespace vibe::rviz_plugins {

/// Adds the triangles of a shape to those of another one.
void appendShape(const ColouredShape& from, ColouredShape& to);

/// Adds the triangles between two rows of vertices, given by the first of each.
/// @param closed  the last vertex of a row is beside the first
void joinRows(std::uint32_t upper, std::uint32_t lower, std::uint32_t count, bool closed, ColouredShape& shape);

}  // namespace vibe::rviz_plugins
