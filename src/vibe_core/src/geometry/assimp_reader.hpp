#pragma once
#include <string>

#include "vibe_core/geometry/surface_mesh.hpp"

namespace vibe {

/// All triangles of a mesh file through the Open Asset Import Library, in the file's unit and axes, with the transforms
/// of its nodes applied; polygons become fans. Runs in a process of its own (see runIsolated()), because damaged files
/// can end that library.
/// @throws Error if the file cannot be read.
SurfaceMesh readWithAssimp(const std::string& path);

}  // namespace vibe
