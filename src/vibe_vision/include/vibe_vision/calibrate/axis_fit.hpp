#pragma once
#include <Eigen/Core>
#include <string>
#include <vector>

#include "vibe_vision/config/vision_config.hpp"

namespace vibe::vision {

/// The marker seen while the instrument stands at a known slide.
struct AxisStop {
  std::string name;                                 ///< of the image, for messages
  double slide = 0;                                 ///< [m]
  Eigen::Vector2d pixel = Eigen::Vector2d::Zero();  ///< centre of the marker, undistorted [px]
};

struct StopResidual {
  double along = 0, across = 0;  ///< seen less fitted [px]
  bool left_out = false;         ///< an outlier
};

struct AxisFit {
  SlideAxis axis;                        ///< with residual_rms and covariance
  std::vector<StopResidual> stops;       ///< in the order given
  double rms_along = 0, rms_across = 0;  ///< of those that were used [px]
  bool perspective_observed = false;     ///< false: perspective is 0
  double perspective_deviation = 0;      ///< standard deviation of the perspective if it is fitted [1/m]
  std::vector<std::string> warnings;     ///< sentences with their remedies
};

constexpr std::size_t kFewestStops = 5;  ///< with different slides, that fitAxis() needs

/// Fits a SlideAxis to stops by least squares; along and across the axis have residuals, and so standard deviations, of
/// their own. A stop whose residual is not explained by the others (deleted Studentised residual, 1 % over all stops;
/// Cook and Weisberg, "Residuals and Influence in Regression", 1982, section 2.2) is left out, at most every fourth.
/// The perspective is kept if it is significant at 99 %, otherwise it is 0.
/// @throws Error with remedy for fewer than kFewestStops different slides, or an instrument that did not move
AxisFit fitAxis(const std::vector<AxisStop>& stops);

/// The marker seen at an unknown slide.
struct MotionSample {
  Eigen::Vector2d pixel = Eigen::Vector2d::Zero();  ///< centre of the marker, undistorted [px]
  double pixels_per_metre = 0;                      ///< from the size at which the marker is seen [px/m]
};

/// What is known about the print and the rig when no slide is known; standard deviations.
struct ScaleTrust {
  double print = 0.005;   ///< relative error of the printed size
  double slant = 0.0873;  ///< angle between axis and sensor [rad]; it shortens the picture by its cosine
};

struct MotionFit {
  SlideAxis axis;                     ///< slide 0 is at the first sample; perspective 0
  double rms_across = 0;              ///< 1.48 times the median distance from the line [px]
  double scale_uncertainty = 0;       ///< relative standard deviation of pixels_per_metre, trust included
  double size_change = 0;             ///< relative change of the marker's size from one end to the other
  std::vector<std::string> warnings;  ///< sentences with their remedies
};

/// Fits an axis to a free motion of the instrument: line through the samples, scale from the known size of the marker.
/// @param direction  roughly where positive slide is, any length; zero: where the last half of the motion went
/// @throws Error with remedy for fewer than 5 samples or an instrument that did not move
MotionFit fitMotion(const std::vector<MotionSample>& samples, const ScaleTrust& trust,
                    const Eigen::Vector2d& direction);

}  // namespace vibe::vision
