#pragma once

#include <array>
#include <vector>

#include <Eigen/Core>

#include "vibe_core/geometry/surface_mesh.hpp"

namespace vibe {

/// One litre per minute [m^3/s].
constexpr double kLitrePerMinute = 1e-3 / 60;

/// Argon plasma coagulation: parameters of the probe and of the thermal effect on the wall. Energies are generator
/// power times time, as in publications. The efficiency is therefore 1 unless energies in the tissue are meant.
struct ApcParameters {
  // the probe, in the working channel of the scope
  double power = 40;                        ///< [W]; 20 and 40 W: Fetz 2021, Endosc Int Open 9:E790
  double efficiency = 1;                    ///< fraction of the power that reaches the tissue
  double argon_flow = 1 * kLitrePerMinute;  ///< [m^3/s]; 1.0 to 1.4 L/min: Fetz 2021
  double probe_length = 0.010;              ///< beyond the tip of the scope [m]; design choice
  /// Largest distance from the end of the probe to tissue [m]. The manufacturer emed specifies 3 mm in endoscopes and 5
  /// mm in open surgery.
  double reach = 0.005;
  /// Radius of the footprint at contact [m]. Design choice. A real lesion of 3 mm is smaller than the particle spacing.
  /// The footprint must be as wide as that spacing, so that published energies per spot apply on every mesh.
  double spot_radius = 0.004;
  double spread = 0.05;  ///< half angle at which the footprint widens with distance [rad]; design choice

  // thresholds of the energy applied to one spot at 40 W without pause [J]
  // A mark is visible. Published marks take 40 to 80 J (20 to 40 W for 2 s, Fetz 2021). A line drawn at 5 mm/s with 20
  // W applies 35 J to each place. Design choice below both.
  double mark_energy = 25;  ///< from which a mark is visible [J]
  /// Mucosa and submucosa are dead. Published: 600 to 800 J (40 to 80 W for 5 to 25 s on human stomach, J Gastroenterol
  /// Hepatol 2017). 425 is 0.71 of 600: the share that the nearest particle receives when the spot is as far as
  /// possible from all particles, on the insufflated default stomach, with the probe at 3 mm.
  double burn_energy = 425;
  double deep_energy = 800;  ///< above it the muscularis is at risk (the same publication) [J]

  // cooling: rates of heat loss [1/s]; no published values for the gastric wall
  // By the surrounding tissue. Design choice: heat leaves a spot of radius a sideways in about a^2 / (4 alpha) = 29 s
  // (a = 4 mm, diffusivity of water alpha = 1.4e-7 m^2/s). Together with the argon this gives 1/30.
  double tissue_cooling = 1.0 / 40;         ///< by the surrounding tissue [1/s]; design choice
  double argon_cooling = 1.0 / 120;         ///< in the footprint, per L/min of argon; design choice [1/s]
  double insufflation_cooling = 1.0 / 600;  ///< everywhere, per L/min of the insufflator; design choice [1/s]

  /// @throws Error if a value is not finite or out of range; the message names the key and the range.
  void check() const;
};

struct Ray;

/// Share of the beam that one particle receives.
struct BeamShare {
  int particle = -1;      ///< its number
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

  const BeamHit& hit() const { return hit_; }  ///< of the last fire(); without a triangle before it
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
