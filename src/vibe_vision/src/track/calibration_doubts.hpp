#pragma once

#include <Eigen/Core>

#include "vibe_vision/track/tracker.hpp"

namespace vibe::vision {

/// How much the picture of a marker is distorted in one way that the model does not have.
struct Distortion {
  double value = 0, variance = 0;  ///< variance 0: the picture does not tell
};

/// What a picture of a moving marker says of such ways.
struct Distortions {
  /// By how many pixels a row of the image further down is moved along the axis.
  Distortion shear;
  /// Of a flat marker: by how much its rim is nearer to the centre along the axis, and further away across it, relative
  /// to its radius. A bent sheet is foreshortened towards its ends, with the cube of the distance. What an aspect or
  /// a size explains, and what all directions share, as a print with much ink, does not count.
  Distortion bend;
};

/// Collects over many frames what speaks against camera and calibration although the marker is tracked.
class CalibrationDoubts {
 public:
  /// @param rows  rows of the image per pixel across the axis, with sign
  explicit CalibrationDoubts(double rows) : rows_(rows) { reset(); }
  void reset();
  void addBend(const Distortion& bend);
  /// @param speed  along the axis [px/s]
  void addShear(const Distortion& shear, double speed);
  /// Of a marker around a rod. @param tilt  that the fit found besides, in the image [rad]
  void addShear(const Distortion& shear, double speed, double tilt, double rotation);
  /// @param log_scale  of the marker against its calibrated size. @param log_gamma  of the response against that given
  void addFit(double log_scale, double log_gamma);

  Doubt doubt() const;
  /// Standard deviation of the place at a speed if the rows of an image are not exposed at the same time [px].
  double shutterError(double speed, int height) const;
  /// The same from what is not known yet about the time between rows; in the unit of speed times s.
  double unknownShutterError(double speed, int height) const;

 private:
  static constexpr int kUnknowns = 4;  ///< time between rows [s]; cosine, sine and mean of the tilt of a sleeve [rad]
  using Vector = Eigen::Matrix<double, kUnknowns, 1>;
  using Matrix = Eigen::Matrix<double, kUnknowns, kUnknowns>;
  void add(const Vector& by, double value, double variance);
  void solve();
  bool isAskew() const;
  double rowTime() const;  ///< between two rows; 0 unless it is significant [s]

  double rows_;
  Matrix information_, covariance_;  ///< of the unknowns, without and with what is likely before any picture
  Vector sums_, mean_;
  double bend_weight_ = 0, bend_sum_ = 0;
  double log_scale_ = 0, log_gamma_ = 0;
  int fits_ = 0;
};

}  // namespace vibe::vision
