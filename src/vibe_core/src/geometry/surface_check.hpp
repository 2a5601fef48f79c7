#pragma once
#include <string>

#include "vibe_core/geometry/surface_mesh.hpp"

namespace vibe {

/// Checks that a surface can become an organ: finite vertices, no triangle without area, every edge between exactly two
/// triangles of the same orientation, every vertex with one fan of triangles, one connected part, no handle, and no
/// self-intersection. Unused vertices are allowed.
/// @param name name of the surface in messages, such as the file
/// @throws Error at the first violated condition, with the number of violations and the place of the first (coordinates
///         as in the mesh).
void checkSurface(const SurfaceMesh& mesh, const std::string& name);

/// Throws if a coordinate is not finite or beyond 1e100, or a triangle refers to a missing vertex.
void checkNumbers(const SurfaceMesh& mesh, const std::string& name);

/// Reverses all triangles if the enclosed volume is negative. Returns whether it did.
bool orientOutwards(SurfaceMesh& mesh);

}  // namespace vibe
