#pragma once
#include <utility>

#include "geometry/triangle_tree.hpp"

namespace vibe {

/// First pair of triangles that cross each other, (-1, -1) if there is none. Triangles that merely touch at the
/// vertices or edges they share do not cross; coplanar overlap and contact without crossing are not found.
std::pair<int, int> findSelfIntersection(const TriangleTree& tree);

}  // namespace vibe
