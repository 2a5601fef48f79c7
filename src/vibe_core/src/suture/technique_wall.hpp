#pragma once
#include <Eigen/Core>
#include <complex>
#include <vector>

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

}  // namespace vibe
