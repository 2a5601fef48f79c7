#pragma once
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "arithmetic/elementary.hpp"
#include "geometry/remesh.hpp"
#include "vibe_core/geometry/surface_mesh.hpp"

namespace vibe::test {

/// Uniformity measures of a triangle surface.
struct MeshQuality {
  double mean_edge = 0;       ///< [m]
  double edge_variation = 0;  ///< standard deviation of the edge lengths over their mean
  double shortest_edge = 0;   ///< [m]
  double longest_edge = 0;    ///< [m]
  double smallest_angle = 0;  ///< of all triangles [rad]
  double largest_bend = 0;    ///< angle between the normals of neighbouring triangles [rad]
  double mean_bend = 0;       ///< root mean square of that angle [rad]
  int smallest_valence = 0;
  int largest_valence = 0;
};

inline double angleBetween(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return math::atan2(a.cross(b).norm(), a.dot(b));
}

inline double smallestAngle(const SurfaceMesh& mesh) {
  double smallest = M_PI;
  for (const auto& t : mesh.triangles) {
    for (int k = 0; k < 3; ++k) {
      const Eigen::Vector3d& corner = mesh.vertices[t[k]];
      smallest = std::min(smallest,
                          angleBetween(mesh.vertices[t[(k + 1) % 3]] - corner, mesh.vertices[t[(k + 2) % 3]] - corner));
    }
  }
  return smallest;
}

inline void measureBends(const SurfaceMesh& mesh, const EditableMesh& editable, MeshQuality& quality) {
  double squares = 0.0;
  int count = 0;
  for (const auto& [a, b] : editable.edges()) {
    const auto [left, right] = editable.wings(a, b);
    const Eigen::Vector3d edge = mesh.vertices[b] - mesh.vertices[a];
    const double bend = angleBetween(edge.cross(mesh.vertices[left] - mesh.vertices[a]),
                                     (mesh.vertices[right] - mesh.vertices[a]).cross(edge));
    quality.largest_bend = std::max(quality.largest_bend, bend);
    squares += bend * bend;
    ++count;
  }
  quality.mean_bend = std::sqrt(squares / count);
}

/// @param mesh closed and manifold, with at least one triangle.
inline MeshQuality measureQuality(const SurfaceMesh& mesh) {
  const EditableMesh editable(mesh);
  MeshQuality quality;
  quality.shortest_edge = std::numeric_limits<double>::infinity();
  double sum = 0.0, squares = 0.0;
  const auto edges = editable.edges();
  for (const auto& edge : edges) {
    const double length = editable.length(edge);
    sum += length;
    squares += length * length;
    quality.shortest_edge = std::min(quality.shortest_edge, length);
    quality.longest_edge = std::max(quality.longest_edge, length);
  }
  const double count = static_cast<double>(edges.size());
  quality.mean_edge = sum / count;
  quality.edge_variation =
      std::sqrt(std::max(0.0, squares / count - quality.mean_edge * quality.mean_edge)) / quality.mean_edge;
  quality.smallest_angle = smallestAngle(mesh);
  measureBends(mesh, editable, quality);
  quality.smallest_valence = editable.vertexEnd();
  for (int v = 0; v < editable.vertexEnd(); ++v) {
    quality.smallest_valence = std::min(quality.smallest_valence, editable.valence(v));
    quality.largest_valence = std::max(quality.largest_valence, editable.valence(v));
  }
  return quality;
}

}  // namespace vibe::test
