#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "vibe_core/suture/technique.hpp"

namespace vibe {

/// Ranges of the random variation of patterns. Each quantity is drawn uniformly between its bounds, per pattern, for
/// every technique. All bounds are design choices: no published measurement of how endoscopists place bites was found.
struct PatternRanges {
  double min_spacing = 0.010, max_spacing = 0.020;  ///< mean distance of successive bites [m]
  double longest = 0.120;                         ///< length of thread from first to last bite [m]; limits the spacing
  double skew = 0.26;                             ///< shear angle, either way [rad]
  double min_stretch = 0.75, max_stretch = 1.33;  ///< ratio of the spacing in one direction to that in the other
  double min_radius = 0.035, max_radius = 0.060;  ///< of the wall about the organ's axis [m]
  double half_length = 0.120;                     ///< of an ellipsoidal organ [m]
};

/// A suture set with its intended technique.
struct TechniquePattern {
  Technique technique;                 ///< that was asked for
  std::vector<Eigen::Vector3d> bites;  ///< [m], in the order in which they are made, in a random pose
};

/// Fewest bites that distinguish a technique from all others: 5 for Square (three sides of a square are a U), else 4.
int fewestBites(Technique technique);

/// Draws one pattern on the inside of a cylinder or an ellipsoid (each half of the time). The same arguments give the
/// same pattern on every machine.
/// @param noise  standard deviation of each coordinate of a bite as a fraction of the mean distance of bites
/// @throws vibe::Error  for Other, fewer bites than fewestBites() or more than kTechniqueMaxBites, or a noise that is
///         negative or not finite
TechniquePattern drawTechniquePattern(Technique technique, int bite_count, double noise, std::uint64_t seed,
                                      const PatternRanges& ranges = {});

/// The same bites in random order: a negative control that shows that the order determines the technique.
std::vector<Eigen::Vector3d> shuffled(std::vector<Eigen::Vector3d> bites, std::uint64_t seed);

}  // namespace vibe
