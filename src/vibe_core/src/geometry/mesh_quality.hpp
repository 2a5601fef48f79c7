#pragma once
#include "vibe_core/geometry/surface_mesh.hpp"

namespace vibe {

/// Uniformity measures of a triangle surface.
struct MeshQuality {
  double mean_edge = 0;       ///< [m]
  double edge_variation = 0;  ///< standard deviation of the edge lengths over their mean [1]
  double shortest_edge = 0;   ///< [m]
  double longest_edge = 0;    ///< [m]
  double smallest_angle = 0;  ///< of all triangles [rad]
  double largest_bend = 0;    ///< angle between the normals of neighbouring triangles [rad]
  double mean_bend = 0;       ///< root mean square of that angle [rad]
  int smallest_valence = 0;
  int largest_valence = 0;
};

/// @param mesh closed and manifold, with at least one triangle.
MeshQuality measureQuality(const SurfaceMesh& mesh);

}  // namespace vibe
