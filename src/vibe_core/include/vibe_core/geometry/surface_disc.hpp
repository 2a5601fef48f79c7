#pragma once

#include <vector>

#include <Eigen/Core>

#include "vibe_core/geometry/surface_mesh.hpp"

namespace vibe {

/// How a disc of a surface is shared out among the vertices: the integral of each vertex's hat function (1 there,
/// linear on the triangles, 0 at all others) over the disc, divided by its area. The weighted mean of the vertices is
/// thus that of all points of the disc, wherever the vertices lie, and a load with these weights is a uniform one on
/// the disc.
struct DiscWeights {
  std::vector<int> vertex;     ///< ascending; on a coarse mesh the corners of one triangle
  std::vector<double> weight;  ///< of each, positive, sum 1
};

/// The disc consists of the points of the surface within `radius` of the centre that are connected to it within the
/// radius: not of a wall opposite to it. Integrals are exact for the triangles. Allocates; a loop over all triangles.
/// @param triangle  that holds the centre
/// @param centre    [m]
/// @param radius    positive [m]
DiscWeights discWeights(const SurfaceMesh& mesh, int triangle, const Eigen::Vector3d& centre, double radius);

/// The disc of the surface at rest around the point of it that is now at `point` of a triangle.
DiscWeights discWeights(const SurfaceMesh& rest, const SurfaceView& now, int triangle, const Eigen::Vector3d& point,
                        double radius);

}  // namespace vibe
