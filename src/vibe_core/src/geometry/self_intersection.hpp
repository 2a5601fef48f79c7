#pragma once
#include <utility>

#include "geometry/triangle_tree.hpp"

namespace vibe {

/// First pair of triangles that cross each other; (-1, -1) if there is none. Contact at shared vertices or edges does
/// not count. Coplanar overlap and contact without crossing are not detected.
std::pair<int, int> findSelfIntersection(const TriangleTree& tree);

}  // namespace vibe
