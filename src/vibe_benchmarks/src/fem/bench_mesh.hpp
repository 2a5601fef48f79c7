#pragma once

#include <Eigen/Core>
#include <array>
#include <map>
#include <string>
#include <vector>

namespace vibe::benchmarks {

/// The mesh of a case: either tetrahedra or triangles, with named groups of nodes.
struct BenchMesh {
  std::vector<Eigen::Vector3d> nodes;            ///< [m]
  std::vector<std::array<int, 4>> tets;          ///< nodes 0 1 2 are counter-clockwise seen from node 3
  std::vector<std::array<int, 3>> triangles;     ///< counter-clockwise from outside
  std::map<std::string, std::vector<int>> sets;  ///< ascending node numbers
};

/// "x y z" per line [m].
/// @throws Error with file and line for anything else
std::vector<Eigen::Vector3d> readNodes(const std::string& file);

/// `size` node numbers per line, from 0; (lines * size).
/// @throws Error with file and line for anything else or a number that is not below `node_count`
std::vector<int> readElements(const std::string& file, int size, int node_count);

/// "name: numbers" per line.
/// @throws Error with file and line
std::map<std::string, std::vector<int>> readSets(const std::string& file, int node_count);

/// A comma-separated table of numbers. Its first line that does not begin with '#' names the columns. An empty entry is
/// NaN.
struct NumberTable {
  std::string file;
  std::vector<std::string> columns;
  std::vector<std::vector<double>> rows;
  int column(const std::string& name) const;  ///< @throws Error that suggests the nearest column
};
NumberTable readTable(const std::string& file);

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

/// The same with triangles whose sides are `pole_edge` long at the poles, grow by a quarter of the distance from the
/// nearer pole, and are nowhere longer than `edge`.
/// @throws Error for lengths that are not positive, or an `edge` shorter than `pole_edge`
BenchMesh makeGradedEllipsoid(double radius, double half_length, double edge, double pole_edge);

/// A solid cylinder about z from z = 0: rings of 6, 12, 18, ... nodes in equal layers, three tetrahedra per prism.
/// Sets: z_min, z_max.
/// @throws Error for lengths or numbers that are not positive
BenchMesh makeCylinder(double radius, double height, int rings, int layers);

/// Divides every triangle into four at the midpoints of its sides. A new node joins the sets that contain both ends of
/// its side.
/// @param project  semi-axes of an ellipsoid about the origin onto which the new nodes are projected; zero: no
///         projection [m]
BenchMesh refineTriangles(const BenchMesh& mesh, const Eigen::Vector3d& project);

/// Adds nodes at the midpoints of two others, numbered after the `before` existing ones, to the sets that contain both.
void growSets(const std::vector<std::array<int, 2>>& middles, int before, BenchMesh& mesh);

}  // namespace vibe::benchmarks
