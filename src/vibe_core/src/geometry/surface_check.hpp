#pragma once
#include <string>

#include "vibe_core/geometry/surface_mesh.hpp"

namespace vibe {

/// Accepts a surface that can become an organ: finite vertices, no triangle without area, every edge between exactly
/// two triangles of the same orientation, every vertex with one fan of triangles, one part, no handle, and no
/// triangle through another. Vertices that no triangle uses are allowed.
/// @param name what messages call the surface, such as the file
/// @throws Error at the first of these that is violated: how often, and where first (coordinates as in the mesh).
void checkSurface(const SurfaceMesh& mesh, const std::string& name);

/// Throws if a vertex is not a finite number, or a triangle refers to a vertex that is not there.
void checkNumbers(const SurfaceMesh& mesh, const std::string& name);

/// Turns all triangles over if the enclosed volume is negative; returns whether it did.
bool orientOutwards(SurfaceMesh& mesh);

}  // namespace vibe
