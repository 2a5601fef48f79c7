#pragma once
#include "method/trajectory.hpp"

namespace vibe {

/// The same mesh and pull with Bullet's btSoftBody: a link per side and per pair of nodes two sides apart, stiffness 1,
/// masses and pressure as the wall has them. Its stiffness depends on the number of iterations and not on a modulus, so
/// it has no force to compare, and its errors say how far it is from the tissue, in displacements since its own
/// inflated start. Times are those of whole frames.
Trajectory runBullet(const BenchWall& wall, const Pull& pull, int steps_per_frame, int iterations);

}  // namespace vibe
