#include "synthetic/sensor_map.hpp"

#include <Eigen/LU>
#include <algorithm>

#include "vibe_core/common/error.hpp"

namespace vibe::vision {
namespace {

/// Derivative of undistort(), from that of its inverse by central differences.
Eigen::Matrix2f derivative(const CameraModel& camera, const Eigen::Vector2d& undistorted) {
  constexpr double kStep = 0.05;  // [px]
  Eigen::Matrix2d distortion;
  for (int i = 0; i < 2; ++i) {
    const Eigen::Vector2d step = kStep * Eigen::Vector2d::Unit(i);
    distortion.col(i) = (distort(camera, undistorted + step) - distort(camera, undistorted - step)) / (2 * kStep);
  }
  return distortion.inverse().cast<float>();
}

}  // namespace

SensorMap::SensorMap(const CameraModel& camera) : camera_(camera) {
  if (!camera.isDistorted()) return;
  entries_.reserve(static_cast<std::size_t>(camera.width) * static_cast<std::size_t>(camera.height));
  for (int y = 0; y < camera.height; ++y)
    for (int x = 0; x < camera.width; ++x) {
      const Eigen::Vector2d place = undistort(camera, {x, y});
      if (!place.allFinite())
        throw Error("synthetic scene: the camera's distortion cannot be inverted at pixel (" + std::to_string(x) +
                    ", " + std::to_string(y) + "); make its coefficients smaller.");
      entries_.push_back({place, derivative(camera, place)});
    }
}

SensorMap::Entry SensorMap::at(int x, int y) const {
  if (entries_.empty()) return {{x, y}, Eigen::Matrix2f::Identity()};
  const int column = std::clamp(x, 0, camera_.width - 1), row = std::clamp(y, 0, camera_.height - 1);
  Entry entry = entries_[static_cast<std::size_t>(row) * static_cast<std::size_t>(camera_.width) +
                         static_cast<std::size_t>(column)];
  const Eigen::Vector2d beyond(x - column, y - row);
  entry.place += entry.jacobian.cast<double>() * beyond;
  return entry;
}

}  // namespace vibe::vision
