#pragma once

#include "fem/bench_mesh.hpp"

namespace vibe::benchmarks {

/// A box of equal cells, each divided into 6 tetrahedra around its diagonal (Kuhn) or into 5 (mirrored from cell to
/// cell). Nodes in the order of x, then y, then z fastest. Sets: the faces x_min, x_max, y_min, y_max, z_min, z_max.
/// @throws Error for a size or number of cells that is not positive, or another number of tetrahedra
BenchMesh makeBox(const Eigen::Vector3d& origin, const Eigen::Vector3d& size, const std::array<int, 3>& cells,
                  int tets_per_cell);

/// A closed surface of exactly `nodes` nodes and nearly equilateral triangles on an ellipsoid of revolution about z. It
/// consists of rings of nodes at equal steps of the meridian's length. The first node is one pole, the last node the
/// other.
/// @param radius, half_length  semi-axes across and along z [m]
/// @throws Error for fewer than 14 nodes or semi-axes that are not positive
BenchMesh makeEllipsoid(double radius, double half_length, int nodes);

/// Divides every triangle into four at the midpoints of its sides. A new node joins the sets that contain both ends of
/// its side.
/// @param project  semi-axes of an ellipsoid about the origin onto which the new nodes are projected; zero: no
///         projection [m]
BenchMesh refineTriangles(const BenchMesh& mesh, const Eigen::Vector3d& project);

/// Adds nodes at the midpoints of two others, numbered after the `before` existing ones, to the sets that contain both.
void growSets(const std::vector<std::array<int, 2>>& middles, int before, BenchMesh& mesh);

}  // namespace vibe::benchmarks
