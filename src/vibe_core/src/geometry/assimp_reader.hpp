#pragma once
#include <string>

#include "geometry/helper_process.hpp"
#include "vibe_core/geometry/surface_mesh.hpp"

namespace vibe {

/// All triangles of a mesh file through the Open Asset Import Library, in the file's unit and axes, with the transforms
/// of its nodes applied; polygons become fans. The program vibe_mesh_reader does this in a process of its own, because
/// damaged files can crash that library. It is found beside the running program or beside this library, or is named by
/// the environment variable VIBE_MESH_READER.
/// @throws Error if the file cannot be read or the program is missing.
SurfaceMesh readWithAssimp(const std::string& path);

/// The same with given limits instead of those that follow from the size of the file.
SurfaceMesh readWithAssimp(const std::string& path, const WorkLimits& limits);

}  // namespace vibe
