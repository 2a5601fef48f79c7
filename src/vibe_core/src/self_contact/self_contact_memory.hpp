#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include <Eigen/Core>

#include "arithmetic/elementary.hpp"
#include "self_contact/self_contact_close.hpp"
#include "self_contact/self_contact_paths.hpp"
#include "self_contact/self_contact_search.hpp"
#include "vibe_core/solver/step_policy.hpp"

namespace vibe {

/// Cosine between normals of walls in contact, at most; in single precision, as the cones of normals have it.
inline double facingCosine() {
  return static_cast<float>(stepPolicy().wall_facing_cosine);
}

/// Energy of a wall that is squeezed to s of its thickness, and its derivatives with respect to s, per A E' t / 2.
struct Squeeze {
  double value, slope, curvature;
};

/// Hencky's bar, equation (18) of docs/computation.md: e = ln(1 - h)^2 / 2, where h grows smoothly from 0 to the strain
/// 1 - s over `onset` on both sides of s = 1.
/// @param straight_below  the energy continues there on its tangent
inline Squeeze squeeze(double s, double straight_below, double onset) {
  if (s >= 1 + onset) return {0, 0, 0};
  const double kept = std::max(s, straight_below), strain = 1 - kept;
  const double ramp = strain + onset;
  const bool full = strain > onset;
  const double h = full ? strain : ramp * ramp / (4 * onset);
  const double h_slope = full ? 1 : ramp / (2 * onset), h_curvature = full ? 0 : 1 / (2 * onset);
  const double hencky = math::log1p(-h), stress = hencky / (1 - h);
  const double slope = stress * h_slope;
  const double curvature = (1 - hencky) / ((1 - h) * (1 - h)) * h_slope * h_slope - stress * h_curvature;
  return {0.5 * hencky * hencky + slope * (s - kept), slope, curvature};
}

/// Smoothed Coulomb friction: potential per friction force and its derivative over the way slid, both as functions of
/// that way, equation (19) of docs/computation.md (Li et al. 2020, "Incremental Potential Contact", section 5.2, f_0
/// and f_1 / |u|).
struct Sliding {
  double way, per_way;  // [m], [1/m]
};
inline Sliding sliding(double way, double smooth) {
  if (way >= smooth) return {way - smooth / 3, 1 / way};
  return {way * way / smooth * (1 - way / (3 * smooth)), (2 - way / smooth) / smooth};
}

/// A triangle that a vertex faces and may touch.
struct WallApproach {
  int triangle;
  Eigen::Vector3d away;    ///< from the triangle to the vertex at detect() [m]
  double distance;         ///< [m]
  Eigen::Vector3d weight;  ///< barycentric, of the nearest point
  double faces;            ///< 1: the triangle faces the vertex, 0: it does not
  double share;            ///< of the contact of the vertex in that direction, before it is divided by the sum
};

/// Working memory of a SelfContact between the calls of a step.
class SelfContactMemory {
 public:
  /// Distances [m].
  /// @param one_wall  along edges within which the surface is one wall
  /// @param floor     minimum distance of paths
  /// @param slack     motion of a vertex for which what was found holds
  /// @param carried   see SelfContactSearch::Settings
  SelfContactMemory(const SurfaceMesh& rest, double one_wall, double cosine, double floor, double slack, bool carried)
      : walls(rest, one_wall),
        search(rest, {walls, cosine, floor, slack, carried}),
        close(rest.triangles, search.rings(), walls),
        paths(rest.triangles, walls, floor),
        position(rest.vertices),
        move(rest.vertices),
        whole(rest.vertices),
        part(rest.vertices.size()),
        length(rest.vertices.size()) {
    for (auto* vectors : {&speed, &start, &end})
      for (std::vector<double>& component : *vectors) component.assign(rest.vertices.size(), 0);
  }
  Eigen::Vector3d at(int node) const { return {start[0][node], start[1][node], start[2][node]}; }
  Eigen::Vector3d speedOf(int node) const { return {speed[0][node], speed[1][node], speed[2][node]}; }
  static SelfContactSearch::NodeVectors view(const std::array<std::vector<double>, 3>& vectors) {
    return {vectors[0].data(), vectors[1].data(), vectors[2].data()};
  }

  SurfaceWalls walls;
  SelfContactSearch search;
  SelfContactClose close;
  SelfContactPaths paths;
  std::array<std::vector<double>, 3> start, end;  // positions at detect(), after the step [m]
  std::array<std::vector<double>, 3> speed;       // at detect() [m/s]
  std::vector<WallApproach> approaches;           // of one vertex
  std::vector<WallApproach*> reached, sharing;    // of these: what it may touch, nearest first; what it acts on
  std::vector<SelfContactClose::Facing> facing;   // what may be close
  std::vector<Eigen::Vector3d> position, move;    // of a step [m]
  std::vector<Eigen::Vector3d> whole;             // moves before they were shortened [m]
  std::vector<double> part, length;               // of the whole moves: what is left of each, its length [m]
};

}  // namespace vibe
