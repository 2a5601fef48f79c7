#pragma once

#include <array>
#include <vector>

#include <Eigen/Core>

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

/// A non-owning view of a deformed surface: the triangles of the rest mesh and positions as a structure of arrays.
struct SurfaceView {
  const std::vector<std::array<int, 3>>& triangles;  ///< vertex numbers
  const std::vector<double>&x, &y, &z;               ///< (vertices) [m]

  /// Of a vertex, whose number is not checked [m].
  Eigen::Vector3d position(int vertex) const { return {x[vertex], y[vertex], z[vertex]}; }
};

/// Whether a point is within a closed surface, which may have folds that cross each other: the surface winds about it
/// at least once. Cost: a loop over the triangles, some 2 ns each.
/// @param point  not on the surface, where either answer may come [m]
bool isWithin(const SurfaceView& surface, const Eigen::Vector3d& point);

/// A finer surface for rendering, bound linearly to the particles. The position of render vertex v is
///   sum over k in [offsets[v], offsets[v+1]) of weights[k] * x[particles[k]],
/// where the weights of a vertex sum to 1. The surface therefore follows every affine motion of the particles exactly.
struct RenderSurface {
  std::vector<std::array<int, 3>> triangles;  ///< render vertex numbers, outward
  std::vector<int> offsets;                   ///< (vertex count + 1)
  std::vector<int> particles;                 ///< (offsets.back())
  std::vector<float> weights;                 ///< (offsets.back())
};

/// Subdivides the particle mesh once by Loop's scheme (Loop 1987), expressed as weights. The result has four times the
/// triangles.
RenderSurface makeLoopSubdivision(const SurfaceMesh& particles);

/// Positions of the render vertices for given particle positions [m].
std::vector<Eigen::Vector3d> renderPositions(const RenderSurface& render_surface,
                                             const std::vector<Eigen::Vector3d>& particles);

}  // namespace vibe
