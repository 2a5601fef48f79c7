#pragma once
#include <Eigen/Core>
#include <vector>

#include "vibe_core/suture/technique.hpp"

namespace vibe::prototype {

/// Current positions of the particles [m], structure of arrays; only read during the call.
struct ParticlePositions {
  const std::vector<double>& x;
  const std::vector<double>& y;
  const std::vector<double>& z;
};

struct IndexGroupSettings {
  /// Radius of the sphere around a particle that a ray must touch to hit the particle [m]. Use at least half the
  /// particle spacing: a ray can pass between smaller spheres.
  double ray_radius = 0;

  /// Maximum number of particles of a group for techniques other than U and Z; the default of the paper.
  int particle_limit = 5;

  /// The groups of a U. false: as printed (first to second bite; first to second corner). true: its two legs (first
  /// bite to first corner; second corner to last bite), which a U of more than four bites draws together.
  bool whole_legs = false;

  /// true: a ray that leaves the wall is bent onto it (see indexGroups()). false: straight rays, as printed.
  bool follow_wall = true;
};

/// The particles that tissue pulling draws to middleOf(bites), in groups, each ordered along its ray: equation 5 of the
/// ViBE paper and the text around it (section 2.1.3).
///   Z      first bite -> second corner; first corner -> last bite
///   U      see IndexGroupSettings::whole_legs
///   else   bite k -> bite k + 1, each at most particle_limit particles; with fewer than two bites no group
/// Equation 5 is printed with "= empty set", which would select the particles that the ray misses. According to the
/// text, the particles between the points are meant, so the particles that it hits are selected. Rays end at their
/// second point. A chord between bites leaves a curved wall and can miss every particle in between. With follow_wall, a
/// ray whose middle is more than two ray_radius from the centre of every particle is replaced by two rays via the
/// particle nearest to its middle, recursively until every piece has a particle at its middle. A ray that still hits
/// none gets the particle nearest to its first point. A particle hit by several rays belongs only to the first group.
/// @throws vibe::Error  arrays of different size or empty, a position that is not finite, ray_radius not above 0,
///         particle_limit below 1, or a U or Z without two corners among the bites
std::vector<std::vector<int>> indexGroups(const ParticlePositions& particles, const std::vector<Eigen::Vector3d>& bites,
                                          const TechniqueResult& technique, const IndexGroupSettings& settings);

/// Target of the groups: the mean of the bites [m]; zero without bites.
Eigen::Vector3d middleOf(const std::vector<Eigen::Vector3d>& bites);

}  // namespace vibe::prototype
