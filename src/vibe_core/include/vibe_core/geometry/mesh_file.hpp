#pragma once
#include <array>
#include <optional>
#include <string>

#include "vibe_core/geometry/surface_mesh.hpp"

namespace vibe {

/// Reads all triangles of an OBJ, STL, PLY, glTF or GLB file (what of them: docs/tutorials/own_mesh.md) in the unit and
/// axes of the file, with its node transforms applied. Vertices closer than a millionth of the size of the surface are
/// merged. Triangles that lose their area by this, and unused vertices, are dropped.
/// @throws Error if the file is missing, is something else in its place (a Git LFS pointer, a web page), has content
///         that its standard does not allow or that is not supported, or has no usable triangles.
SurfaceMesh readMeshFile(const std::string& path);

/// Whether the format of a file with this name prescribes metres: glTF 2.0 does (Khronos 2021, section 3.4). The other
/// formats state no unit.
bool statesMetres(const std::string& path);

/// Axes of medical images: x, y, z point to the patient's right, front and head, or to the left, the back and the head.
enum class PatientAxes { Ras, Lps };

/// The axes that 3D Slicer states as SPACE=RAS or SPACE=LPS: in the name or header of an STL, in comments of an OBJ or
/// PLY. Empty if the file states none.
std::optional<PatientAxes> statedAxes(const std::string& path);

/// Roll, pitch and yaw from these axes to ours (x front, y left, z head) [rad].
std::array<double, 3> rotationOf(PatientAxes axes);

/// Drops vertices without a triangle, merges those that are closer than a part of the longest side of the box around
/// the surface, and drops the triangles and vertices that vanish.
/// @param raw   has passed checkNumbers()
/// @param part  from 0
SurfaceMesh weld(const SurfaceMesh& raw, double part);

}  // namespace vibe
