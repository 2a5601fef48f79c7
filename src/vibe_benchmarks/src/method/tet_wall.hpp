#pragma once
#include "method/trajectory.hpp"

namespace vibe {

/// The same wall as one layer of linear tetrahedra: a node inside and one outside per node of the mesh, three
/// tetrahedra per triangle, what is held held on both sides, the pressure on the surface halfway between them.
/// Nodes 0 .. n-1 are the inner ones.
BenchWall makeTetWall(const BenchWall& wall);

/// As follow(), of a tetrahedral wall, with its own inflated start. Frames hold the means of the inner and the outer
/// nodes, so that they compare with those of the surface; its errors are those of the element and of the stepping.
Trajectory runTets(const BenchWall& wall, const Pull& pull, const StepChoice& choice);

}  // namespace vibe
