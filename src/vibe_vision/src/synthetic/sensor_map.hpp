#pragma once
#include <Eigen/Core>
#include <vector>

#include "vibe_vision/image/camera_model.hpp"

namespace vibe::vision {

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
