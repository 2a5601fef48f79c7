#pragma once
#include "vibe_rviz_plugins/geometry/coloured_shape.hpp"

namespace vibe {

/// Adds the triangles of a shape to those of another one.
void appendShape(const ColouredShape& from, ColouredShape& to);

}  // namespace vibe
