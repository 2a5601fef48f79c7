#pragma once
#include <string>

#include "vibe_core/geometry/surface_mesh.hpp"

namespace vibe {

// Format of the data from vibe_mesh_reader to readWithAssimp(). All numbers are in the byte order of the machine.
//
//   surface:  8 bytes  "VIBEMESH"
//             uint64   number of vertices V
//             uint64   number of triangles T
//             double   x, y, z of each vertex, 3 V numbers, in the unit and axes of the file
//             int32    vertices of each triangle, 3 T numbers, from 0; checkNumbers() checks their range
//   failure:  8 bytes  "VIBEFAIL"
//             text     the reason as a clause, to the end
//
// Limits: at most 2^31 - 1 vertices and triangles; nothing follows the last number.

/// Serialises a surface.
std::string packMesh(const SurfaceMesh& mesh);

/// Serialises a failure.
std::string packFailure(const std::string& reason);

/// Deserialises a surface.
/// @throws Error with the reason if the bytes contain a failure, or if they are incomplete or too long
SurfaceMesh unpackMesh(const std::string& bytes);

}  // namespace vibe
