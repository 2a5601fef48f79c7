#pragma once

#include <array>
#include <complex>
#include <vector>

#include <Eigen/Core>

#include "vibe_core/suture/technique.hpp"

namespace vibe {

/// Bites laid flat: on a plane, or on an unrolled cylinder.
struct FlatBites {
  std::vector<std::complex<double>> bites;  ///< centred
  double off_wall = 0;                      ///< sum of squared distances from the plane or cylinder
  double wrap = 0;                          ///< angle that the bites span around the cylinder [rad]; plane: 0
};

/// Lays the bites flat on every candidate plane and cylinder; the plane is first. Needs four or more bites that do not
/// all coincide. The wall itself is unknown here, and a row around a cylinder is the same set of points as an arc in a
/// plane. The function therefore returns all candidates, and the caller prefers the flattest.
std::vector<FlatBites> layFlat(const std::vector<Eigen::Vector3d>& bites);

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
