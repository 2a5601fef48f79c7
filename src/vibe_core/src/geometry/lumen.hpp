#pragma once
#include <vector>

#include "vibe_core/geometry/surface_mesh.hpp"

namespace vibe {

/// Volume enclosed by the surface at given vertex positions [m^3].
double lumenVolume(const SurfaceMesh& surface, const std::vector<double>& x, const std::vector<double>& y,
                   const std::vector<double>& z);

}  // namespace vibe
