#pragma once
#include <Eigen/Core>

namespace vibe::vision {

/// Where an instrument slides, in undistorted pixels of the full sensor: the marker's centre at slide s is at
///   origin + direction * along(s),   along(s) = pixels_per_metre * s / (1 + perspective * s)
/// exact for a straight axis seen by a pinhole camera. `perspective` is 0 if the axis is parallel to the sensor.
struct SlideAxis {
  Eigen::Vector2d origin = Eigen::Vector2d::Zero();      ///< at slide 0 [px]
  Eigen::Vector2d direction = Eigen::Vector2d::UnitX();  ///< unit vector, to positive slide
  double pixels_per_metre = 0;                           ///< at slide 0 [px/m]
  double perspective = 0;                                ///< [1/m]
  double residual_rms = 0;                               ///< of the calibration, along the axis [m]; 0: not known
  /// Of origin along and across the axis [px], angle of the direction [rad], pixels_per_metre and perspective; SI, and
  /// zero where it is not known.
  Eigen::Matrix<double, 5, 5> covariance = Eigen::Matrix<double, 5, 5>::Zero();

  bool isCalibrated() const { return pixels_per_metre > 0; }
};

double alongOf(const SlideAxis& axis, double slide);         ///< [m] -> [px]
double slideOf(const SlideAxis& axis, double along);         ///< [px] -> [m]
double pixelsPerMetre(const SlideAxis& axis, double slide);  ///< d along / d slide [px/m]

}  // namespace vibe::vision
