#pragma once

#include "vibe_vision/track/tracker.hpp"

namespace vibe::vision {

/// How much the picture of a marker is sheared: by how many pixels along the axis a pixel further across it.
struct Shear {
  double value = 0, variance = 0;
};

/// Collects over many frames what speaks against camera and calibration although the marker is tracked.
class CalibrationDoubts {
 public:
  void reset() { *this = {}; }
  /// @param speed  along the axis [px/s]
  /// @param rows  of the image per pixel across the axis, with sign
  void addShear(const Shear& shear, double speed, double rows);
  /// @param log_scale  of the marker against its calibrated size
  void addSize(double log_scale);
  Doubt doubt() const;
  /// Standard deviation of the place at a speed if the rows of an image are not exposed at the same time [px].
  double shutterError(double speed, int height) const;

 private:
  double rowTime() const;  ///< between two rows; 0 unless it is significant [s]

  double squares_ = 0, products_ = 0;  ///< of speed, and of speed and shear, over the variance of the shear
  double log_scale_ = 0;
  int sizes_ = 0;
};

}  // namespace vibe::vision
