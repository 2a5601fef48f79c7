#pragma once
#include <string>

#include "vibe_core/geometry/surface_mesh.hpp"

namespace vibe {

/// Reads all triangles of an OBJ, STL, PLY, glTF or GLB file, in the file's own unit and axes, with the transforms of
/// its nodes applied. Vertices at the same place (within a millionth of the size) become one, triangles that thereby
/// lose their area are dropped, and so are vertices that no triangle uses.
/// @throws Error if the file is missing, of another type, not readable, or without usable triangles.
SurfaceMesh readMeshFile(const std::string& path);

/// Whether a file of this name is in metres by its format: glTF 2.0 (Khronos 2021), section 3.4. The others state no
/// unit.
bool statesMetres(const std::string& path);

/// Makes vertices that are closer together than `tolerance` one, and drops triangles and vertices that vanish.
SurfaceMesh weld(const SurfaceMesh& mesh, double tolerance);

}  // namespace vibe
