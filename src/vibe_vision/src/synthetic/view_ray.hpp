#pragma once
#include "synthetic/marker_frame.hpp"

namespace vibe::vision {

/// One coordinate of the ray through a pixel, linear in the pixel: value + x dx + y dy.
struct RayPart {
  float value = 0, dx = 0, dy = 0;
  float at(float x, float y) const { return value + x * dx + y * dy; }
};

/// Rays of an ideal camera around a reference pixel: the part of the ray (X, Y, 1) in a direction.
class ViewRay {
 public:
  ViewRay(const CameraModel& camera, const Eigen::Vector2d& reference)
      : inverse_focal_(1 / camera.fx, 1 / camera.fy),
        centre_((reference.x() - camera.cx) / camera.fx, (reference.y() - camera.cy) / camera.fy, 1) {}

  /// Weighted by any vector [m].
  RayPart part(const Eigen::Vector3d& weight) const {
    return {static_cast<float>(weight.dot(centre_)), static_cast<float>(weight.x() * inverse_focal_.x()),
            static_cast<float>(weight.y() * inverse_focal_.y())};
  }
  /// Through the reference; its z is 1.
  const Eigen::Vector3d& centre() const { return centre_; }
  /// Change of the ray per pixel: (x, 0, 0) and (0, y, 0).
  const Eigen::Vector2d& perPixel() const { return inverse_focal_; }

 private:
  Eigen::Vector2d inverse_focal_;
  Eigen::Vector3d centre_;
};

}  // namespace vibe::vision
