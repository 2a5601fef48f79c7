#pragma once
#include "method/trajectory.hpp"

namespace vibe::benchmarks {

/// The same wall as one layer of linear tetrahedra: an inner and an outer node per node of the mesh and three
/// tetrahedra per triangle. Held nodes are held on both sides, and the pressure acts on the surface halfway between
/// them. Nodes 0 .. n-1 are the inner ones.
BenchWall makeTetWall(const BenchWall& wall);

/// Like update(), for a wall of tetrahedra with its own inflated start. Frames hold the means of the inner and the
/// outer nodes, so that they are comparable with those of the surface. Its errors are those of the element and of the
/// time stepping.
Trajectory runTets(const BenchWall& wall, const Pull& pull, const StepChoice& choice);

}  // namespace vibe::benchmarks
