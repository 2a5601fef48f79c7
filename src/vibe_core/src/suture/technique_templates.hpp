#pragma once
#include <array>
#include <complex>
#include <vector>

#include "vibe_core/suture/technique.hpp"

namespace vibe {

/// One ideal drawing of a technique: bites in a plane, centred, of unit second moment (sum of squares 1).
struct TechniqueTemplate {
  Technique technique;
  std::vector<std::complex<double>> bites;
  std::array<int, 2> corners{-1, -1};  ///< bites at the two corners of a U or Z
  std::complex<double> own;            ///< sum of conj(bite)^2: how far from round the drawing is, 0 to 1
  double weight = 1;                   ///< relative to the other drawings of the technique; they sum to 1
};

/// All ideal drawings with this number of bites (kTechniqueLeastBites or more), each also in reversed order.
std::vector<TechniqueTemplate> techniqueTemplates(int bite_count);

}  // namespace vibe
