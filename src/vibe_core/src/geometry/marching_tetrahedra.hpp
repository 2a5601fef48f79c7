#pragma once
#include <Eigen/Geometry>
#include <functional>

#include "vibe_core/geometry/surface_mesh.hpp"

namespace vibe {

/// Extracts the closed zero surface of a field, oriented towards positive values. Cubes are cut into six tetrahedra
/// each (Kuhn), so the result is always manifold. Its triangles are uneven: remesh before use.
/// @param field signed: negative inside, positive on the boundary of the box
/// @param box   [m]
/// @param cell  edge of a cube [m]
SurfaceMesh marchTetrahedra(const std::function<double(const Eigen::Vector3d&)>& field, const Eigen::AlignedBox3d& box,
                            double cell);

}  // namespace vibe
