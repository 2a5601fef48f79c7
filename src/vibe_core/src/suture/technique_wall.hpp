#pragma once
#include <Eigen/Core>
#include <complex>
#include <vector>

namespace vibe {

/// Bites laid flat: on a plane, or on a cylinder that was cut open.
struct FlatBites {
  std::vector<std::complex<double>> bites;  ///< centred
  double off_wall = 0;                      ///< sum of squares of the distances from the plane or cylinder
  double wrap = 0;                          ///< angle that the bites span around the cylinder [rad]; plane: 0
};

/// The plane and the cylinders that the bites could lie on; the plane is first. Four or more bites, not all in one
/// place. The wall itself is not known to a recogniser that sees bites only, and a row around a cylinder is the same
/// set of points as an arc in a plane: hence all candidates, and a caller that prefers the flattest.
std::vector<FlatBites> layFlat(const std::vector<Eigen::Vector3d>& bites);

}  // namespace vibe
