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

}  // namespace vibe::benchmarks
