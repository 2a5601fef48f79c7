#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "vibe_vision/image/camera_model.hpp"
#include "vibe_vision/marker/marker_design.hpp"

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

  bool isCalibrated() const { return pixels_per_metre > 0; }  ///< false: nothing can be tracked along it
};

double alongOf(const SlideAxis& axis, double slide);         ///< [m] -> [px]
double slideOf(const SlideAxis& axis, double along);         ///< [px] -> [m]
double pixelsPerMetre(const SlideAxis& axis, double slide);  ///< d along / d slide [px/m]

Eigen::Vector2d acrossOf(const SlideAxis& axis);  ///< unit vector, to the right of the direction (y down)
/// Undistorted pixel of a place along the axis and across it [px].
Eigen::Vector2d pixelAt(const SlideAxis& axis, double along, double lateral = 0);

/// Noise of a pixel, in grey values (DN): variance = gain * value + read^2 (photon transfer, EMVA 1288).
struct PixelNoise {
  double gain = 0.096;  ///< [DN]; 10.6 ke- full well and 12 dB of analogue gain
  double read = 0.6;    ///< standard deviation in the dark, rounding included [DN]
};

/// How fast an instrument may move; what moves faster is not the instrument.
struct MotionLimits {
  double max_speed = 0.8;         ///< [m/s]
  double max_acceleration = 30;   ///< [m/s^2]
  double max_angular_speed = 40;  ///< of the rod [rad/s]
};

/// One instrument: a marker that slides along an axis.
struct InstrumentConfig {
  std::string name;                               ///< e.g. "helix", "needle_driver"
  MarkerDesign marker;                            ///< what to look for
  double ink = 0;                                 ///< by which black reaches beyond its edges on the print [m]
  SlideAxis axis;                                 ///< where; not calibrated only with AxisRule::Optional
  double lower = 0, upper = 0;                    ///< slide beyond which nothing is looked for [m]
  double lateral_tolerance = 5e-4;                ///< by which the marker's centre may leave the axis [m]
  MotionLimits motion;                            ///< what is possible for the hand that holds it
  std::string slide_joint;                        ///< name in JointState, e.g. "helix_advance"
  std::string rotation_joint;                     ///< empty for a ring
  double slide_sign = 1, slide_offset = 0;        ///< joint = sign * slide + offset [m]
  double rotation_sign = 1, rotation_offset = 0;  ///< [rad]
};

/// What counts as seen. Everything else is reported as lost, with the reason.
struct GateConfig {
  double min_contrast = 20;       ///< white - black [DN]
  double min_visible = 0.4;       ///< share of the marker's information that must be seen, 0 to 1
  double max_scale_error = 0.15;  ///< of the marker's size relative to the calibrated one
  double max_tilt = 0.35;         ///< of the marker in the image [rad]
};

/// Whether a configuration may lack the axes of its instruments: before a calibration it does.
enum class AxisRule { Required, Optional };

/// Everything the tracker needs to know about a rig. docs/vision.md, "Configuration".
struct VisionConfig {
  CameraModel camera;  ///< lens and sensor
  PixelNoise noise;    ///< of the sensor
  /// Of the response: a pixel shows 255 (light / 255)^(1 / gamma). Not given: 1, or what a marker tells that 1 does not
  /// explain; an exponent.
  std::optional<double> gamma;
  double blur = 0.6;                          ///< standard deviation of the point spread function in focus [px]
  GateConfig gates;                           ///< of all instruments
  std::vector<InstrumentConfig> instruments;  ///< of the rig; parse() takes 1 to kMaxInstruments

  /// @param address  file, or package:// address
  /// @throws Error with file, line, key and remedy
  static VisionConfig load(const std::string& address, AxisRule rule = AxisRule::Required);
  /// @param place  what to call the text in errors
  static VisionConfig parse(const std::string& yaml, const std::string& place, AxisRule rule = AxisRule::Required);

  /// @return index in `instruments`. @throws Error for an unknown name, with those there are
  std::size_t indexOf(const std::string& instrument) const;
};

/// YAML that parse() reads back to the same values, bit by bit, with residuals of calibrations: every key with its SI
/// unit, without axes that are not calibrated. What parse() refuses is written all the same.
std::string toYaml(const VisionConfig& config);

}  // namespace vibe::vision
