#pragma once
#include <string>

#include "vibe_core/geometry/surface_mesh.hpp"

namespace vibe {

/// Reads all triangles of an OBJ, STL, PLY, glTF or GLB file in the unit and axes of the file, with its node transforms
/// applied. Vertices closer than a millionth of the size of the surface are merged. Triangles that lose their area by
/// this, and unused vertices, are dropped.
/// @throws Error if the file is missing, has an unsupported type, cannot be read, or has no usable triangles.
SurfaceMesh readMeshFile(const std::string& path);

/// Whether the format of a file with this name prescribes metres: glTF 2.0 does (Khronos 2021, section 3.4). The other
/// formats state no unit.
bool statesMetres(const std::string& path);

/// Merges vertices closer than `tolerance` and drops the triangles and vertices that vanish.
SurfaceMesh weld(const SurfaceMesh& mesh, double tolerance);

}  // namespace vibe
