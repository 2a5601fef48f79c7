#pragma once
#include <string>

#include "vibe_core/geometry/surface_mesh.hpp"

namespace vibe {

// What the program vibe_mesh_reader writes and readWithAssimp() reads. All numbers are in the byte order of the
// machine.
//
//   surface:  8 bytes  "VIBEMESH"
//             uint64   number of vertices V
//             uint64   number of triangles T
//             double   x, y, z of each vertex, 3 V numbers, in the file's unit and axes
//             int32    vertices of each triangle, 3 T numbers, from 0; checkNumbers() checks their range
//   failure:  8 bytes  "VIBEFAIL"
//             text     a clause that says why, to the end
//
// Limits: at most 2^31 - 1 vertices and triangles; nothing follows the last number.

/// The bytes for a surface.
std::string packMesh(const SurfaceMesh& mesh);

/// The bytes for a failure.
std::string packFailure(const std::string& reason);

/// The surface in such bytes.
/// @throws Error with the reason if they hold a failure, and if they are incomplete or longer than they say
SurfaceMesh unpackMesh(const std::string& bytes);

}  // namespace vibe
