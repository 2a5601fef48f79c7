#pragma once
#include "fem/bench_mesh.hpp"

namespace vibe::benchmarks {

/// Divides every triangle into four at the midpoints of its sides. A new node joins the sets that contain both ends of
/// its side.
/// @param project  semi-axes of an ellipsoid about the origin onto which the new nodes are projected; zero: no
///         projection [m]
BenchMesh refineTriangles(const BenchMesh& mesh, const Eigen::Vector3d& project);

/// Adds nodes at the midpoints of two others, numbered after the `before` existing ones, to the sets that contain both.
void growSets(const std::vector<std::array<int, 2>>& middles, int before, BenchMesh& mesh);

}  // namespace vibe::benchmarks
