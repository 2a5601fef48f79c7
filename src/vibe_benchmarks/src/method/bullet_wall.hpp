#pragma once
#include "method/trajectory.hpp"

namespace vibe::benchmarks {

/// The same mesh and pull with Bullet's btSoftBody: a link per side and per pair of nodes two sides apart, stiffness 1,
/// and the masses and pressure of the wall. Its stiffness depends on the number of iterations and not on a modulus, so
/// its force is not comparable. Its errors are the difference from the tissue, in displacements from its own inflated
/// start. Times are those of whole frames.
Trajectory runBullet(const BenchWall& wall, const Pull& pull, int steps_per_frame, int iterations);

}  // namespace vibe::benchmarks
