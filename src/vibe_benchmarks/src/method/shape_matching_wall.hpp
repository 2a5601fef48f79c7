#pragma once
#include "method/trajectory.hpp"

namespace vibe::benchmarks {

/// The same mesh, masses, damping and pull with the simulator's shape matching and its position-based solver, with the
/// number of sub-steps that the stiffness requires; the disc moves 17 times per frame. Young's modulus is that of the
/// wall, but the law is linear in the stretch, shear is as stiff as dilation, and bending follows from the size of the
/// clusters. The errors are the difference between the model and the tissue. The force is elasticity and pressure on
/// the disc at the ends of the frames. Times are those of whole frames.
/// @param substeps  out: per frame
Trajectory runShapeMatching(const BenchWall& wall, const Pull& pull, int& substeps);

}  // namespace vibe::benchmarks
