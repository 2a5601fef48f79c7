#pragma once
#include <string>

#include "geometry/helper_process.hpp"
#include "vibe_core/geometry/surface_mesh.hpp"

namespace vibe {

/// Reads all triangles of a mesh file with the Open Asset Import Library, in the unit and axes of the file, with its
/// node transforms applied. Polygons become triangle fans. The program vibe_mesh_reader does this in a separate
/// process, because damaged files can crash that library. The program is found beside the running program or beside
/// this library, or through the environment variable VIBE_MESH_READER.
/// @throws Error if the file cannot be read or the program is missing.
SurfaceMesh readWithAssimp(const std::string& path);

/// The same with given limits instead of those derived from the size of the file.
SurfaceMesh readWithAssimp(const std::string& path, const WorkLimits& limits);

}  // namespace vibe
