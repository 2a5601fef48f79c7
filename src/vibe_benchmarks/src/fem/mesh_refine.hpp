#pragma once
#include "fem/bench_mesh.hpp"

namespace vibe {

/// Cuts every triangle into four at the middles of its sides; a new node joins the sets that hold both ends of its
/// side.
/// @param project  semi-axes of an ellipsoid about the origin on which the new nodes are put; zero: they stay [m]
BenchMesh refineTriangles(const BenchMesh& mesh, const Eigen::Vector3d& project);

/// Adds nodes in the middle of two others, numbered after the `before` ones, to the sets that hold both.
void growSets(const std::vector<std::array<int, 2>>& middles, int before, BenchMesh& mesh);

}  // namespace vibe
