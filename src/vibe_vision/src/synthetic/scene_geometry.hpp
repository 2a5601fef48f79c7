#pragma once

#include <vector>

#include <Eigen/Core>

#include "vibe_vision/image/camera_model.hpp"
#include "vibe_vision/synthetic/synthetic_scene.hpp"

namespace vibe::vision {

/// The straight line in space whose picture is a SlideAxis, in the camera frame.
struct AxisLine {
  Eigen::Vector3d origin, direction;  ///< at slide 0 [m], unit vector
};
AxisLine axisLine(const CameraModel& camera, const SlideAxis& axis);

/// Where a marker is in space, in the camera frame. The unit vectors are orthogonal; across is to the right of along in
/// the image, away points from the camera.
struct MarkerFrame {
  Eigen::Vector3d centre;  ///< [m]
  Eigen::Vector3d along, across, away;
  double scale = 1;     ///< printed size relative to the design
  double rotation = 0;  ///< of a rod [rad]
};
MarkerFrame markerFrame(const CameraModel& camera, const SyntheticInstrument& instrument, double time);

/// Pixel without the lens's distortion. @param point  [m], in front of the camera
Eigen::Vector2d projectIdeal(const CameraModel& camera, const Eigen::Vector3d& point);

/// Half extents of a marker's printed surface along and across [m], times its scale; a tag's with its white border.
Eigen::Vector2d halfExtents(const SyntheticInstrument& instrument);

/// Where each pixel looks without the lens's distortion, with the derivative there. Beyond the image the map goes on
/// linearly from the nearest pixel.
class SensorMap {
 public:
  struct Entry {
    Eigen::Vector2d place;     ///< undistorted [px]
    Eigen::Matrix2f jacobian;  ///< undistorted by distorted
  };

  explicit SensorMap(const CameraModel& camera);
  Entry at(int x, int y) const;

 private:
  CameraModel camera_;
  std::vector<Entry> entries_;  ///< empty: no distortion
};

}  // namespace vibe::vision
