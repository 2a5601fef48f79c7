#pragma once
#include "vibe_core/geometry/surface_mesh.hpp"

namespace vibe {

/// Low-pass filter of an evenly meshed surface that hardly shrinks it (Taubin 1995, lambda 0.5, mu -0.53).
void smoothTaubin(SurfaceMesh& mesh, int iterations);

/// Moves every vertex by the same distance along its normal until the enclosed volume is reached. Intended for changes
/// of a few percent, where it preserves the shape.
void offsetToVolume(SurfaceMesh& mesh, double volume);

/// Scales about the origin to the volume and returns the factor [1].
double scaleToVolume(SurfaceMesh& mesh, double volume);

}  // namespace vibe
