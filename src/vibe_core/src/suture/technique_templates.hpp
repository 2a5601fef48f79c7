#pragma once
#include <array>
#include <complex>
#include <vector>

#include "vibe_core/suture/technique.hpp"

namespace vibe {

/// An ideal drawing of a technique: bites in a plane, centred, with unit second moment (sum of squares 1).
struct TechniqueTemplate {
  Technique technique;
  std::vector<std::complex<double>> bites;
  std::array<int, 2> corners{-1, -1};  ///< bites at the two corners of a U or Z
  std::complex<double> own;            ///< sum of conj(bite)^2: deviation of the drawing from roundness, 0 to 1
  double weight = 1;                   ///< relative to the other drawings of the technique; they sum to 1
};

/// All ideal drawings with this number of bites (kTechniqueMinBites or more), each also in reversed order.
std::vector<TechniqueTemplate> techniqueTemplates(int bite_count);

}  // namespace vibe
