#pragma once
#include "vibe_core/geometry/surface_mesh.hpp"

namespace vibe {

/// Low-pass filter of an evenly meshed surface that hardly shrinks it (Taubin 1995, lambda 0.5, mu -0.53).
void smoothTaubin(SurfaceMesh& mesh, int iterations);

/// Moves every vertex by the same distance along its normal so that the enclosed volume is reached.
/// For changes of a few percent: the surface keeps its shape but for that distance.
void offsetToVolume(SurfaceMesh& mesh, double volume);

/// Scales about the origin to the volume; returns the factor [1].
double scaleToVolume(SurfaceMesh& mesh, double volume);

}  // namespace vibe
