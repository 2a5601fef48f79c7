#pragma once
#include <Eigen/Core>
#include <array>
#include <vector>

namespace vibe {

/// A triangle surface. It is closed and oriented outwards once checkSurface() has accepted it.
struct SurfaceMesh {
  std::vector<Eigen::Vector3d> vertices;      ///< positions [m]
  std::vector<std::array<int, 3>> triangles;  ///< vertex numbers, counter-clockwise seen from outside
};

/// Volume enclosed by a closed surface, positive if oriented outwards [m^3].
double enclosedVolume(const SurfaceMesh& mesh);

/// Sum of the triangle areas [m^2].
double surfaceArea(const SurfaceMesh& mesh);

/// One third of the area of the triangles around each vertex [m^2]. The sum is surfaceArea().
std::vector<double> vertexAreas(const SurfaceMesh& mesh);

/// Area-weighted unit normals; zero for a vertex without triangles.
std::vector<Eigen::Vector3d> vertexNormals(const SurfaceMesh& mesh);

/// Neighbours of every vertex along edges, each list in ascending order.
std::vector<std::vector<int>> vertexNeighbours(const SurfaceMesh& mesh);

}  // namespace vibe
