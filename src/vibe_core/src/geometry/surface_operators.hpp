#pragma once

#include <vector>

#include <Eigen/SparseCore>

#include "vibe_core/geometry/surface_mesh.hpp"

namespace vibe {

/// Stiffness matrix of the Laplacian with linear elements on the surface (cotangent weights), symmetric,
/// positive semi-definite, rows summing to zero. Shape (vertices, vertices).
Eigen::SparseMatrix<double> cotangentStiffness(const SurfaceMesh& mesh);

/// The function that is 0 on `zeros`, 1 on `ones` and harmonic on the rest of the surface, one value per vertex.
/// @throws Error if the linear system cannot be solved (a triangle without area, or an unconnected part).
std::vector<double> harmonicField(const SurfaceMesh& mesh, const std::vector<int>& zeros, const std::vector<int>& ones);

/// Smooths values over the surface by diffusion with about this width. Preserves their area-weighted mean.
/// @param width standard deviation of the diffusion kernel [m]
std::vector<double> diffuse(const SurfaceMesh& mesh, const std::vector<double>& values, double width);

/// Length of the shortest path along edges from the nearest seed to every vertex; infinity if there is none [m]. On an
/// even mesh such paths are up to about 15 % longer than those across the surface.
std::vector<double> edgeDistances(const SurfaceMesh& mesh, const std::vector<int>& seeds);

/// Low-pass filter of an evenly meshed surface that hardly shrinks it (Taubin 1995, lambda 0.5, mu -0.53).
void smoothTaubin(SurfaceMesh& mesh, int iterations);

/// Moves every vertex by the same distance along its normal until the enclosed volume is reached. Intended for changes
/// of a few percent, where it preserves the shape.
void offsetToVolume(SurfaceMesh& mesh, double volume);

/// Scales about the origin to the volume and returns the factor.
double scaleToVolume(SurfaceMesh& mesh, double volume);

/// Volume enclosed by the surface at given vertex positions [m^3].
double lumenVolume(const SurfaceMesh& surface, const std::vector<double>& x, const std::vector<double>& y,
                   const std::vector<double>& z);

}  // namespace vibe
