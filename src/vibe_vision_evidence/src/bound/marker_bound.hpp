#pragma once
#include <cstdint>

#include "vibe_vision/synthetic/synthetic_scene.hpp"

namespace vibe::vision::evidence {

/// Smallest standard deviation that any unbiased estimator can have (Cramer-Rao bound), from the expected picture, its
/// derivatives and the photon-transfer variance. Unknown are the position along and across, gain and offset of the
/// light, and the rotation if the marker shows it; known are size, tilt, blur and what is behind the marker. The edge
/// of the paper, which people cut, does not count, nor do saturated pixels; the outline of a rod does. The information
/// in the variance itself is left out: it is below a hundredth. S. M. Kay, "Fundamentals of Statistical Signal
/// Processing: Estimation Theory", 1993, section 3.9.
struct MarkerBound {
  double along = 0;     ///< [px]
  double rotation = 0;  ///< [rad]; 0 if the marker does not show it
};
/// @throws Error if too little of the marker is seen
MarkerBound cramerRaoBound(const SyntheticScene& scene, std::size_t instrument, std::uint64_t index);

}  // namespace vibe::vision::evidence
