#pragma once
#include <Eigen/Core>
#include <functional>

#include "vibe_core/common/progress.hpp"
#include "vibe_core/geometry/surface_mesh.hpp"

namespace vibe {

/// Returns the nearest point of the surface onto which a remeshed surface is projected.
using Projection = std::function<Eigen::Vector3d(const Eigen::Vector3d&)>;

/// Covers a closed surface evenly with exactly `vertices` vertices: isotropic remeshing by splits, collapses, flips
/// and tangential relaxation (Botsch and Kobbelt, A remeshing approach to multiresolution modeling, 2004), then
/// single splits or collapses until the number is met. Deterministic.
/// @param input    closed, oriented, manifold and near the surface (see checkSurface())
/// @param vertices at least 12
/// @param project  the surface itself; must be continuous near the input
/// @throws Error if so few vertices cannot carry the shape.
SurfaceMesh remesh(const SurfaceMesh& input, int vertices, const Projection& project, const Progress& progress = {});

/// Deviation of a remeshed surface from its input.
struct RemeshReport {
  double mean_distance = 0;  ///< from the new vertices to the input [m]
  double max_distance = 0;   ///< [m]
  double volume_error = 0;   ///< (new - old) / old [1]
  bool smoothed = false;     ///< the input was coarser than the result, and its creases were smoothed
};

/// Calls remesh() on the triangles of the input, preserving its volume. Where the input is coarser than the result, its
/// creases are smoothed (Taubin, A signal processing approach to fair surface design, 1995).
SurfaceMesh remeshSurface(const SurfaceMesh& input, int vertices, RemeshReport* report = nullptr,
                          const Progress& progress = {});

}  // namespace vibe
