#pragma once
#include <Eigen/Core>
#include <array>
#include <vector>

#include "vibe_core/geometry/surface_mesh.hpp"
#include "vibe_core/geometry/surface_view.hpp"
#include "vibe_core/thermal/apc_parameters.hpp"

namespace vibe {

struct Ray;

/// Share of the beam that one particle receives.
struct BeamShare {
  int particle = -1;
  double power = 0;       ///< into the wall area of the particle; the shares sum to power * efficiency [W]
  double spot_power = 0;  ///< the same per area, times the area of the footprint at contact [W]
  double cover = 0;       ///< coverage by the footprint: 1 at its centre, 0 at its rim
};

/// Intersection of the beam with the wall.
struct BeamHit {
  int triangle = -1;                                ///< -1: no tissue in reach
  Eigen::Vector3d point = Eigen::Vector3d::Zero();  ///< on the mid-surface, in world [m]
  double gap = 0;                                   ///< from the end of the probe to the tissue; 0: contact [m]
  double radius = 0;                                ///< of the footprint [m]
};

/// The argon plasma beam of the endoscope: selects the particles of a deformed wall that are heated and computes their
/// power.
///
/// The beam is a ray from the tip of the scope. It heats the first triangle that it hits and nothing behind it. The
/// footprint lies around the hit point, on the part of the surface that is connected to it and faces the probe:
///   q(d) ~ exp(-(d/r)^4 / 2),  r = spot_radius + gap * tan(spread),
/// The profile is flat in the middle because dried tissue conducts worse, so the arc moves on to the tissue beside it.
/// The form is a design choice. Particles share the power in proportion to q times their area. The power is therefore
/// conserved to rounding, and the power per area converges under refinement. Because q is flat, a particle at a
/// distance of 0.7 r from the centre of a spot still receives 0.89 of the maximum power per area.
///
/// Limits: The ray is straight, so tissue beside the probe is not found. d is the straight distance, so the footprint
/// is too long across folds sharper than r. On meshes with a particle spacing above 1.7 r the footprint is as wide as
/// the mesh can represent.
///
/// Holds scratch memory but no state. Allocates in its first calls only. Not thread-safe.
class ArgonBeam {
 public:
  /// @param surface  the wall at rest, for its connections
  explicit ArgonBeam(const SurfaceMesh& surface);

  /// @param tip        of the scope, in world [m]
  /// @param direction  of the beam, in world; any nonzero length
  /// @param wall       deformed, with the triangles of the surface at rest
  /// @param half_wall  distance from the mid-surface to the mucosa [m]
  /// There is no hit if a component of the pose is not finite.
  const BeamHit& fire(const Eigen::Vector3d& tip, const Eigen::Vector3d& direction, const SurfaceView& wall,
                      double half_wall, const ApcParameters& parameters);

  const BeamHit& hit() const { return hit_; }
  const std::vector<BeamShare>& shares() const {
    return shares_;
  }  ///< of the last fire(), in order of connection from the hit

 private:
  void spreadOver(const Ray& ray, const SurfaceView& wall, const ApcParameters& parameters);
  void collect(const Ray& ray, const SurfaceView& wall);
  double areaFacing(int particle, const Ray& ray, const SurfaceView& wall) const;

  std::vector<std::vector<int>> neighbours_, triangles_of_;  ///< (vertices)
  std::vector<char> seen_;                                   ///< (vertices), 0 between calls
  std::vector<int> patch_;
  std::vector<BeamShare> shares_;
  BeamHit hit_;
};

}  // namespace vibe
