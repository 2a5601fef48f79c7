#pragma once
#include <memory>

#include "synthetic/marker_frame.hpp"

namespace vibe::vision {

/// A marker at one moment, as seen through small square apertures: what share of each it covers, and how white it is
/// there. Edges are integrated over the aperture by their distance, not sampled.
class Surface {
 public:
  virtual ~Surface() = default;
  /// @param x, y      centres of the apertures, undistorted [px], relative to the reference of makeSurface
  /// @param coverage  0: beside the marker, 1: on it
  /// @param white     reflectance of the marker in the aperture
  virtual void row(const float* x, const float* y, int count, float* coverage, float* white) const = 0;
};

/// @param reference  undistorted pixel that coordinates are relative to
/// @param aperture   side of the apertures, undistorted [px]
std::unique_ptr<Surface> makeSurface(const CameraModel& camera, const SyntheticInstrument& instrument,
                                     const MarkerFrame& frame, const Eigen::Vector2d& reference, double aperture);

}  // namespace vibe::vision
