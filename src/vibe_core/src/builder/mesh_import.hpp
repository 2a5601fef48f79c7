#pragma once
#include "vibe_core/geometry/organ.hpp"
#include "vibe_core/geometry/surface_mesh.hpp"
#include "vibe_core/scene/scene.hpp"

namespace vibe {

/// A surface from a file, in our unit and axes.
struct ImportedMesh {
  SurfaceMesh surface;  ///< closed, oriented outwards [m]
  Landmarks landmarks;  ///< in the same frame [m]
};

/// Reads geometry.file and brings it to metres (geometry.unit, or geometry.target_volume) and to our axes
/// (geometry.rotation_rpy); the landmarks go the same way.
/// A unit of 0 is accepted for glTF, whose standard prescribes metres, and with a target volume, which alone
/// determines the size. The largest side of the result, before geometry.scale, must be 5 cm to 1 m.
/// @throws Error if the file cannot be read (see readMeshFile()), the surface cannot be used (see checkSurface()), the
///         unit is missing or implausible, or a landmark is missing.
ImportedMesh importMesh(const GeometryScene& geometry);

}  // namespace vibe
