#pragma once
#include <Eigen/Core>
#include <array>
#include <vector>

#include "vibe_core/geometry/surface_mesh.hpp"
#include "vibe_core/geometry/surface_view.hpp"
#include "vibe_core/thermal/apc_parameters.hpp"

namespace vibe {

/// What one particle gets of the beam.
struct BeamShare {
  int particle = -1;
  double power = 0;       ///< into the wall that the particle stands for; the shares sum to power * efficiency [W]
  double spot_power = 0;  ///< the same per area, times the area of the footprint at contact [W]
  double cover = 0;       ///< of the footprint: 1 in its middle, 0 at its rim
};

/// Where the beam meets the wall.
struct BeamHit {
  int triangle = -1;                                ///< -1: nothing in reach
  Eigen::Vector3d point = Eigen::Vector3d::Zero();  ///< on the mid-surface, in world [m]
  double gap = 0;                                   ///< from the probe's end to the tissue; 0: it touches [m]
  double radius = 0;                                ///< of the footprint [m]
};

/// The argon plasma beam of the endoscope: which particles of a deformed wall it heats, and with what power.
///
/// The beam is a ray from the scope's tip; the first triangle that it meets is heated, what lies behind is not. The
/// footprint lies around the point met, on the part of the surface that is connected to it and faces the probe:
///   q(d) ~ exp(-(d/r)^4 / 2),  r = spot_radius + gap * tan(spread),
/// flat in the middle: dried tissue conducts worse, so the arc leaves it for what is beside it. The form is a design
/// choice. Particles share the power by q times the area around them, so the power is conserved to rounding and the
/// power per area converges under refinement. Because q is flat, a particle at a distance of 0.7 r from the middle of
/// a spot still gets 0.89 of the greatest power per area.
///
/// Limits: a straight ray: tissue beside the probe is not found. d is the straight distance, so the footprint is too
/// long across folds sharper than r. On meshes coarser than 1.7 r between particles the footprint is as wide as the
/// mesh can carry.
///
/// Holds scratch memory and no state; allocates in its first calls only; not shared between threads of control.
class ArgonBeam {
 public:
  /// @param surface  the wall at rest, for its connections
  explicit ArgonBeam(const SurfaceMesh& surface);

  /// @param tip        of the scope, in world [m]
  /// @param direction  of the beam, in world; any length but zero
  /// @param wall       deformed, with the triangles of the surface at rest
  /// @param half_wall  from the mid-surface to the mucosa [m]
  /// Nothing is hit if a number of the pose is not finite.
  const BeamHit& fire(const Eigen::Vector3d& tip, const Eigen::Vector3d& direction, const SurfaceView& wall,
                      double half_wall, const ApcParameters& parameters);

  const BeamHit& hit() const { return hit_; }
  const std::vector<BeamShare>& shares() const { return shares_; }  ///< of the last fire(), nearest connection first

 private:
  struct Ray;
  void cast(const Ray& ray, const SurfaceView& wall);
  void spreadOver(const Ray& ray, const SurfaceView& wall, const ApcParameters& parameters);
  void collect(const Ray& ray, const SurfaceView& wall);
  double areaFacing(int particle, const Ray& ray, const SurfaceView& wall) const;

  std::vector<std::vector<int>> neighbours_, triangles_of_;  ///< (vertices)
  std::vector<char> seen_;                                   ///< (vertices), 0 between calls
  std::vector<int> patch_;
  std::vector<BeamShare> shares_;
  BeamHit hit_;
  double ray_length_ = 0;  ///< to the hit
};

}  // namespace vibe
