#pragma once
#include <Eigen/Core>
#include <vector>

#include "vibe_core/geometry/surface_mesh.hpp"

namespace vibe {

/// A finer surface for rendering, bound linearly to the particles. The position of render vertex v is
///   sum over k in [offsets[v], offsets[v+1]) of weights[k] * x[particles[k]],
/// where the weights of a vertex sum to 1. The surface therefore follows every affine motion of the particles exactly.
struct RenderSurface {
  std::vector<std::array<int, 3>> triangles;  ///< render vertex numbers, outward
  std::vector<int> offsets;                   ///< (vertex count + 1)
  std::vector<int> particles;                 ///< (offsets.back())
  std::vector<float> weights;                 ///< (offsets.back())
};

/// Subdivides the particle mesh once by Loop's scheme (Loop 1987), expressed as weights. The result has four times the
/// triangles.
RenderSurface makeLoopSubdivision(const SurfaceMesh& particles);

/// Positions of the render vertices for given particle positions [m].
std::vector<Eigen::Vector3d> renderPositions(const RenderSurface& render_surface,
                                             const std::vector<Eigen::Vector3d>& particles);

}  // namespace vibe
