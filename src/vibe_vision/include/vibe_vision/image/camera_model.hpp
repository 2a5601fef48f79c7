#pragma once
#include <Eigen/Core>
#include <array>
#include <string>

namespace vibe::vision {

/// Pinhole camera with the distortion model "plumb_bob" of sensor_msgs/CameraInfo (Brown 1971): x right, y down, z
/// forward. Pixels are those of the full sensor; see Frame::offset_x.
struct CameraModel {
  int width = 0, height = 0;           ///< of the full image [px]
  double fx = 0, fy = 0;               ///< [px]
  double cx = 0, cy = 0;               ///< [px]
  std::array<double, 5> distortion{};  ///< coefficients k1, k2, p1, p2, k3 of OpenCV's model
  double reprojection_rms = 0;         ///< residual of the calibration [px]; 0: not calibrated

  bool isDistorted() const;  ///< any coefficient is not 0
};

/// "728 x 544", of an image [px].
inline std::string sizeText(int width, int height) {
  return std::to_string(width) + " x " + std::to_string(height);
}
/// @throws Error "WHOSE 640 x 480 px, the configuration is for 728 x 544 px; REMEDY" for another size than the camera's
void requireSize(const CameraModel& camera, int width, int height, const std::string& whose, const std::string& remedy);

/// Pixel of the image as a camera without distortion, with the same matrix, would see it.
/// Newton iterations to 1e-9 px. @return NaN outside of where the model can be inverted
Eigen::Vector2d undistort(const CameraModel& camera, const Eigen::Vector2d& pixel);
/// Inverse of undistort().
Eigen::Vector2d distort(const CameraModel& camera, const Eigen::Vector2d& undistorted);
/// Of a point in the camera frame [m], z > 0.
Eigen::Vector2d project(const CameraModel& camera, const Eigen::Vector3d& point);

}  // namespace vibe::vision
