#pragma once
#include <Eigen/Core>
#include <array>
#include <memory>
#include <vector>

#include "vibe_vision/config/vision_config.hpp"

namespace vibe::vision {

/// Where and how a marker is seen. All in undistorted pixels, along the slide axis and across it.
///
/// A point of the marker that is X along and Y across its centre [px at the pattern's pixels_per_metre] is seen at
///   x = exp(log_scale + log_aspect) * X, y = exp(log_scale) * Y, then (x, y) * (1 + keystone * x),
/// turned by `tilt`, from (along, lateral)
struct MarkerPose {
  double along = 0;       ///< centre, at the middle of the exposure [px]
  double lateral = 0;     ///< centre, to the right of the direction (y down) [px]
  double rotation = 0;    ///< of the rod [rad]
  double log_scale = 0;   ///< log of the size across, relative to the pattern's pixels_per_metre
  double tilt = 0;        ///< in the image, from the direction to the right [rad]
  double log_aspect = 0;  ///< log of (size along / size across); a slanted marker has less than 0
  double blur = 0;        ///< standard deviation of the point spread function [px], without the pixel's own area
  double keystone = 0;    ///< relative growth of the picture along the marker: one end is nearer to the camera [1/px]
  /// Of a rod, out of the image plane; positive: its positive end is further from the camera [rad]. It bends the bars,
  /// which shows the sign too. A flat marker has log_aspect and keystone instead.
  double slant = 0;
};
constexpr int kPoseParameters = 9;  ///< in MarkerPose
/// Places in the arrays below.
enum PoseIndex { kAlong, kLateral, kRotation, kLogScale, kTilt, kLogAspect, kBlur, kKeystone, kSlant };

/// Vectors of floats are filled up to a multiple of this.
constexpr std::size_t kLanes = 8;

/// Pixels to compare with, as structure of arrays: undistorted position along and across the axis, relative to
/// SlideAxis::origin [px]. The arrays have room for any window and are filled up from `count` to a multiple of kLanes
/// with copies of the last pixel, with weight 0.
struct PixelBlock {
  std::vector<float> along, lateral, value;  ///< where each pixel is [px], and its grey value [DN]
  std::vector<float> light;   ///< on this pixel, relative to the marker's mean; 1 unless somebody knows better
  std::vector<float> sheen;   ///< what the surface mirrors to this pixel, whatever is printed there [DN]; 0 likewise
  std::vector<float> weight;  ///< 0: nothing can be said about this pixel (saturated, outside of the image), else 1
  std::size_t count = 0;      ///< of pixels; what is behind them is filled up

  /// `count` filled up to a multiple of kLanes.
  std::size_t padded() const { return (count + kLanes - 1) / kLanes * kLanes; }
  /// Room for this many pixels; none are in it.
  void allocate(std::size_t capacity);
  void pad();                                            ///< fills up behind `count`
  std::size_t capacity() const { return value.size(); }  ///< pixels that there is room for
};

/// Reflectance that the camera should see at each pixel (0: black, 1: white), with the derivatives by the pose. Arrays
/// have the capacity of the PixelBlock; those of parameters that the marker does not show are empty.
struct PatternValues {
  std::vector<float> value;  ///< 0 to 1, per pixel
  std::array<std::vector<float>, kPoseParameters>
      derivative;  ///< per parameter of the pose, in its unit, and pixel [1/px], [1/rad] or a ratio

  /// Room for this many pixels. @param observed  as MarkerPattern::observes(); others get no derivatives
  void allocate(std::size_t capacity, const std::array<bool, kPoseParameters>& observed);
};

/// How a marker moves along the axis during the exposure, about its mean place.
struct MarkerMotion {
  double length = 0;  ///< from the first place to the last [px]
  /// Of an accelerated motion: the first and the last place are further along by this much than in an even one, the
  /// middle is as much behind. Acceleration times the square of the exposure, by 16 [px].
  double bend = 0;
  double turn = 0;  ///< of the rotation, in the same time [rad]

  /// From a length alone it is a motion with even speed [px].
  MarkerMotion(double its_length = 0, double its_bend = 0, double its_turn = 0)
      : length(its_length), bend(its_bend), turn(its_turn) {}
};

/// The picture of a marker as a function of its pose: blurred by optics, the area of a pixel (1 px) and the motion
/// during the exposure.
class MarkerPattern {
 public:
  virtual ~MarkerPattern() = default;

  /// True for parameters that the picture depends on.
  virtual std::array<bool, kPoseParameters> observes() const = 0;
  /// Half extents along and across the axis [px] of the pixels that are worth reading: they hold what the marker
  /// tells. What they show of the surroundings of a tilted marker, select() takes out.
  virtual Eigen::Vector2d window(const MarkerPose& pose, double motion) const = 0;
  /// The largest window() that there can be.
  virtual Eigen::Vector2d maxWindow() const = 0;

  /// Distance of the outermost edge along the axis from the centre, in pixels of the pattern.
  virtual double rim() const = 0;

  /// Makes ready for evaluations near a pose; once per frame. No allocation.
  /// @param rough  the picture may be wrong by a few percent in a few places: enough to find the marker
  virtual void prepare(const MarkerPose& pose, const MarkerMotion& motion, bool rough = false) = 0;
  /// The pattern near the prepared pose: exact in position, rotation, size and tilt, to first order in the change of
  /// the blur. Fills values up to pixels.padded(). No allocation.
  virtual void evaluate(const MarkerPose& pose, const PixelBlock& pixels, PatternValues& values) = 0;
  /// Takes pixels out of the block that tell nothing (deep in a white or black area) or that do not show the marker.
  /// The order of the others stays.
  virtual void select(const MarkerPose& pose, double motion, PixelBlock& pixels) const;

  /// For the search along the axis: mean reflectance over |lateral| <= searchHalfWidth() at steps of 1 px along the
  /// axis, the middle one at the marker's centre, for a mean rotation; of odd length.
  virtual double searchHalfWidth() const = 0;  ///< [px]
  /// Fills that mean reflectance, 0 to 1.
  /// @param motion  during the exposure, along the axis [px]
  /// @param scale  of the marker's size, relative to the pattern's pixels_per_metre
  virtual void searchProfile(double motion, double scale, std::vector<float>& profile) const = 0;
  /// What the rotation adds to that: cos(rotation) * cosine + sin(rotation) * sine, as long as the profile; empty for a
  /// marker that does not show it.
  virtual void searchTurns(double /*motion*/, double /*scale*/, std::vector<float>& cosine,
                           std::vector<float>& sine) const {
    cosine.clear();
    sine.clear();
  }
  /// Rotations to try when nothing predicts it [rad].
  virtual std::vector<double> rotationGuesses() const { return {0}; }
};

/// From where a camera looks at the slide axis. The picture of a rod is that of a pinhole camera: away from the middle
/// of the image its bars bend although the rod is parallel to the sensor. MarkerPose::slant is against the sensor.
struct MarkerView {
  double focal_length = 1e9;     ///< CameraModel::fx [px]; large: without perspective
  double principal_along = 0;    ///< of the camera's principal point, relative to SlideAxis::origin [px]
  double principal_lateral = 0;  ///< across the axis [px]
};
/// The view of a calibrated camera on an axis.
MarkerView markerView(const CameraModel& camera, const SlideAxis& axis);

/// Of a ring or a sleeve. @param pixels_per_metre  scale at which the marker is seen at log_scale 0
/// @throws Error for a tag
std::unique_ptr<MarkerPattern> makePattern(const MarkerDesign& design, double pixels_per_metre,
                                           const MarkerView& view = {});

}  // namespace vibe::vision
