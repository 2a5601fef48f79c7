#pragma once
#include <Eigen/Core>
#include <vector>

#include "vibe_core/suture/technique.hpp"

namespace vibe {

/// Positions of the particles now [m], structure of arrays; only read during the call.
struct ParticlePositions {
  const std::vector<double>& x;
  const std::vector<double>& y;
  const std::vector<double>& z;
};

struct IndexGroupSettings {
  /// Radius of the sphere that a ray must touch to hit a particle [m]. Half the distance of neighbouring particles
  /// or more: between smaller ones a ray can pass unhindered.
  double ray_radius = 0;

  /// Most particles of a group of techniques other than U and Z [1]; the paper's default.
  int particle_limit = 5;

  /// The groups of a U: false: as printed (first to second bite; first to second corner). true: its two legs (first
  /// bite to first corner; second corner to last bite), which are what a U of more than four bites brings together.
  bool whole_legs = false;

  /// Bends a ray onto the wall where it leaves it (see indexGroups()); false: straight, as printed.
  bool follow_wall = true;
};

/// The particles that tissue pulling draws to middleOf(bites), in groups, each in order along its ray: equation 5 of
/// the ViBE paper and the text around it (section 2.1.3).
///   Z      first bite -> second corner; first corner -> last bite
///   U      see IndexGroupSettings::whole_legs
///   else   bite k -> bite k + 1, each at most particle_limit particles; with fewer than two bites no group
/// Equation 5 is printed with "= empty set", which would collect the particles that the ray does not meet; the text
/// says between the points, so those that it meets are collected. Rays end at their second point.
/// A chord between bites leaves a curved wall and can miss every particle in between. With follow_wall a ray whose
/// middle is more than two ray_radius from the centre of every particle is replaced by two, over the particle nearest
/// to its middle, and so on until every piece has a particle at its middle. A ray that meets none all the
/// same gets the particle nearest to its first point. A particle met by several rays belongs to the first group only.
/// @throws vibe::Error  arrays of different size or empty, a position that is not finite, ray_radius not above 0,
///                      particle_limit below 1, or a U or Z without two corners among the bites
std::vector<std::vector<int>> indexGroups(const ParticlePositions& particles, const std::vector<Eigen::Vector3d>& bites,
                                          const TechniqueResult& technique, const IndexGroupSettings& settings);

/// Where the groups are drawn to: the mean of the bites [m]; zero without bites.
Eigen::Vector3d middleOf(const std::vector<Eigen::Vector3d>& bites);

}  // namespace vibe
