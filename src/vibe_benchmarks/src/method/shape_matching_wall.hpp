#pragma once
#include "method/trajectory.hpp"

namespace vibe {

/// The same mesh, masses, damping and pull with the simulator's shape matching and its position-based solver, with as
/// many sub-steps as carry the stiffness; the disc moves on 17 times per frame. Young's modulus is that of the wall,
/// but the law is linear in the stretch, shear is as stiff as dilation and bending follows from the size of the
/// clusters: the errors say how far the model is from the tissue. The force is elasticity and pressure on the disc at
/// the ends of the frames. Times are those of whole frames.
/// @param substeps  out: per frame
Trajectory runShapeMatching(const BenchWall& wall, const Pull& pull, int& substeps);

}  // namespace vibe
