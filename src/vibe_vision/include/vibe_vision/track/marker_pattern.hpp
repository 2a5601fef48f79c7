#pragma once
#include <Eigen/Core>
#include <array>
#include <memory>
#include <vector>

#include "vibe_vision/config/vision_config.hpp"

namespace vibe {

/// Where and how a marker is seen, around its calibrated place. All in undistorted pixels and along the axis.
struct MarkerPose {
  double along = 0;       ///< centre [px]
  double lateral = 0;     ///< centre, to the right of the direction (y down) [px]
  double rotation = 0;    ///< of the rod [rad]
  double log_scale = 0;   ///< log of the size relative to pixelsPerMetre at `along`
  double tilt = 0;        ///< in the image [rad]
  double log_aspect = 0;  ///< log of (size along / size across) relative to a marker that looks at the camera
  double blur = 0;        ///< standard deviation of the point spread function [px]
  /// Of a rod, out of the image plane; positive: its positive end is further from the camera [rad]. It bends the bars,
  /// which shows the sign too. A flat marker has log_aspect instead.
  double slant = 0;
};
constexpr int kPoseParameters = 8;
using PoseVector = Eigen::Matrix<double, kPoseParameters, 1>;  ///< in the order of MarkerPose

/// Pixels to compare with, as structure of arrays: undistorted position along and across the axis, relative to
/// SlideAxis::origin [px].
struct PixelBlock {
  std::vector<float> along, lateral, value;
  std::size_t size() const { return value.size(); }
};

/// Reflectance that the camera should see at each pixel (0: black, 1: white), with the derivatives by the pose.
struct PatternValues {
  std::vector<float> value;
  std::array<std::vector<float>, kPoseParameters> derivative;  ///< empty where the marker does not show a parameter
};

/// The picture of a marker as a function of its pose: blurred by optics and by the motion during the exposure.
class MarkerPattern {
 public:
  virtual ~MarkerPattern() = default;

  /// True for parameters that the picture depends on.
  virtual std::array<bool, kPoseParameters> observes() const = 0;
  /// Half extents of the printed surface along and across the axis [px] at log_scale 0; the model holds no further out
  /// than this less blur and half the motion.
  virtual Eigen::Vector2d halfExtents() const = 0;
  /// @param motion  by which the marker moves along the axis during the exposure [px], signed
  virtual void evaluate(const MarkerPose& pose, double motion, const PixelBlock& pixels,
                        PatternValues& values) const = 0;
};

/// @param pixels_per_metre  scale at which the marker is seen
std::unique_ptr<MarkerPattern> makePattern(const MarkerDesign& design, double pixels_per_metre);

}  // namespace vibe
